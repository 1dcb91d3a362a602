// What stands in README.md between `<!-- figures: NAME -->` and `<!-- end -->`.

import { readFileSync, writeFileSync } from "node:fs";

const PAGE = new URL("../README.md", import.meta.url);

function split(name) {
  const text = readFileSync(PAGE, "utf8");
  const start = `<!-- figures: ${name} -->\n`;
  const from = text.indexOf(start) + start.length;
  const to = text.indexOf("\n<!-- end -->", from);
  if (from < start.length || to < 0) throw new Error(`README.md has no place for ${name}`);
  return [text.slice(0, from), text.slice(from, to), text.slice(to)];
}

/** Whether the page says so; with $WRITE it says so afterwards. */
export function says(name, wanted) {
  const [before, said, after] = split(name);
  if (process.env.WRITE && said !== wanted) writeFileSync(PAGE, before + wanted + after);
  return Boolean(process.env.WRITE) || said === wanted;
}
