// A static folder with HTTP ranges, which can be told to misbehave.

import { createReadStream } from "node:fs";
import { readFile, stat } from "node:fs/promises";
import { createServer } from "node:http";
import { join, normalize } from "node:path";

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };

/** Replies of `answer(name)` take the place of the file's: { status }, { body }, { destroy } the connection, or { whole }, the
 * file whatever range was asked; null for the file. */
export async function serve(folder, answer = () => null) {
  const log = [];
  const server = createServer(async (request, response) => {
    const name = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname)).replace(/^\/$/, "/index.html");
    const instead = answer(name);
    const range = instead?.whole ? null : /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
    const path = join(folder, name);
    const type = TYPES[/\.\w+$/.exec(name)?.[0]] ?? "application/octet-stream";
    if (instead?.destroy) return response.destroy();
    if (instead?.status) return response.writeHead(instead.status).end();
    try {
      const body = instead?.body;
      const length = body ? body.length : (await stat(path)).size;
      const [first, last] = range ? [Number(range[1]), Math.min(Number(range[2]), length - 1)] : [0, length - 1];
      log.push({ name, bytes: last - first + 1 });
      const headers = { "Content-Type": type, "Content-Length": last - first + 1, "Cache-Control": "no-store" };
      if (range) headers["Content-Range"] = `bytes ${first}-${last}/${length}`;
      response.writeHead(range ? 206 : 200, headers);
      if (body) response.end(body.subarray(first, last + 1));
      else createReadStream(path, { start: first, end: last }).pipe(response);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  return { log, url: `http://127.0.0.1:${server.address().port}/`, close: () => server.close(), read: (name) => readFile(join(folder, name)) };
}
