// Pictures of `welkin render`, and how far those of the page are from them.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const WELKIN = process.env.WELKIN ?? "welkin";

/** The bytes of a picture with these arguments. */
export function render(extension, args) {
  const folder = mkdtempSync(join(tmpdir(), "welkin-web-"));
  try {
    const out = join(folder, `sky.${extension}`);
    const compression = extension === "exr" ? ["--exr-compression", "none"] : [];
    execFileSync(WELKIN, ["render", "--out", out, ...compression, ...args], { stdio: ["ignore", "ignore", "inherit"] });
    return readFileSync(out);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** Differences of the page's picture to a PNG in levels of 0 to 255, over the rows above `part` of the height: the mean,
 * that of 99 of 100 values, and the largest; and the mean of the PNG. */
export function difference(page, png, part = 1) {
  return page.evaluate(
    async ({ base64, part }) => {
      const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
      const values = async (source) => {
        const image = await createImageBitmap(source, { colorSpaceConversion: "none" });
        const canvas = new OffscreenCanvas(image.width, image.height);
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0);
        const rows = Math.floor(image.height * part);
        return { size: [image.width, image.height], data: context.getImageData(0, 0, image.width, rows).data };
      };
      const theirs = await values(new Blob([bytes], { type: "image/png" }));
      const canvas = document.getElementById("sky");
      const mine = await values(await new Promise((done) => canvas.toBlob(done, "image/png")));
      if (String(mine.size) !== String(theirs.size)) throw new Error(`${mine.size} is not ${theirs.size}`);
      const all = [];
      let level = 0;
      for (let i = 0; i < mine.data.length; i++) {
        if (i % 4 === 3) continue;
        all.push(Math.abs(mine.data[i] - theirs.data[i]));
        level += theirs.data[i];
      }
      all.sort((a, b) => a - b);
      const mean = all.reduce((a, b) => a + b) / all.length;
      return { mean, p99: all[Math.floor(0.99 * all.length)], most: all.at(-1), level: level / all.length };
    },
    { base64: png.toString("base64"), part },
  );
}

/** Planes of an EXR of 32-bit floats without compression, by name. */
export function readExr(bytes) {
  let at = 8;
  const text = () => {
    const end = bytes.indexOf(0, at);
    const found = bytes.toString("utf8", at, end);
    at = end + 1;
    return found;
  };
  if (bytes.readInt32LE(0) !== 20000630) throw new Error("no EXR");
  const attributes = new Map();
  for (let name = text(); name !== ""; name = text()) {
    text();
    const length = bytes.readInt32LE(at);
    attributes.set(name, bytes.subarray(at + 4, at + 4 + length));
    at += 4 + length;
  }
  if (attributes.get("compression")[0] !== 0) throw new Error("compressed");
  const box = attributes.get("dataWindow");
  const [width, height] = [box.readInt32LE(8) + 1, box.readInt32LE(12) + 1];
  const names = [];
  const list = attributes.get("channels");
  for (let from = 0; list[from] !== 0; ) {
    const end = list.indexOf(0, from);
    names.push(list.toString("latin1", from, end));
    from = end + 17;
  }
  const planes = Object.fromEntries(names.map((name) => [name, new Float32Array(width * height)]));
  // Lines of the width, or tiles: the library writes these.
  const tile = attributes.get("tiles");
  const [across, down] = tile ? [tile.readUInt32LE(0), tile.readUInt32LE(4)] : [width, 1];
  const [columns, rows] = [Math.ceil(width / across), Math.ceil(height / down)];
  for (let i = 0; i < columns * rows; i++) {
    let from = Number(bytes.readBigUInt64LE(at + 8 * i)) + (tile ? 20 : 8);
    const [left, top] = [(i % columns) * across, Math.floor(i / columns) * down];
    for (let y = top; y < Math.min(top + down, height); y++) {
      for (const name of names) {
        for (let x = left; x < Math.min(left + across, width); x++, from += 4) {
          planes[name][y * width + x] = bytes.readFloatLE(from);
        }
      }
    }
  }
  return { width, height, planes };
}

/** What the command says of a picture, by the first word of its lines. */
function report(args) {
  const folder = mkdtempSync(join(tmpdir(), "welkin-web-"));
  try {
    const out = join(folder, "sky.png");
    const text = execFileSync(WELKIN, ["render", "--size", "16", "--out", out, ...args], { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
    return Object.fromEntries(text.split("\n").map((line) => [line.split(" ")[0], line]));
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** Elevation and azimuth (degrees) of the command's sun; null where its model has none. */
export function sunOf({ date, time, latitude, longitude }) {
  try {
    const { sun } = report(["--date", date, "--time", time, "--latitude", `${latitude}`, "--longitude", `${longitude}`]);
    const [, elevation, azimuth] = /elevation (-?[\d.]+)°, azimuth (-?[\d.]+)°/.exec(sun);
    return { elevation: Number(elevation), azimuth: Number(azimuth) };
  } catch (error) {
    if (/solar elevation/.test(String(error.stderr))) return null;
    throw error;
  }
}

/** The visibility (km) of a turbidity. */
export function turbidityOf({ turbidity }) {
  return Number(/visibility ([\d.]+) km/.exec(report(["--turbidity", `${turbidity}`]).conditions)[1]);
}
