// Modules of the page, and what a page gives.

import { readFileSync } from "node:fs";
import { build } from "esbuild";

/** Exports of one of the page's own modules. */
export async function bundled(name) {
  const entry = new URL(`../src/${name}`, import.meta.url).pathname;
  const { outputFiles } = await build({ entryPoints: [entry], bundle: true, format: "esm", write: false });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].text).toString("base64")}`);
}

/** What one of the buttons saves. */
export async function download(page, id) {
  const [file] = await Promise.all([page.waitForEvent("download"), page.locator(`#${id}`).click()]);
  return readFileSync(await file.path());
}

/** What is read under the pointer at shares of width and height, with at least so many wavelengths: the radiance, the
 * degree of polarisation, and the lines of the chart. */
export async function reading(page, [x, y], wavelengths = 1) {
  await page.evaluate(
    ([x, y]) => {
      const canvas = document.getElementById("sky");
      const { left, top } = canvas.getBoundingClientRect();
      document.getElementById("reading").textContent = "";
      // A mouse has whole pixels only.
      const event = new PointerEvent("pointermove", { clientX: left, clientY: top });
      Object.defineProperty(event, "offsetX", { value: x * canvas.clientWidth });
      Object.defineProperty(event, "offsetY", { value: y * canvas.clientHeight });
      canvas.dispatchEvent(event);
    },
    [x, y],
  );
  await page.waitForFunction((count) => {
    const lines = document.querySelectorAll("#spectrum polyline");
    const isThere = document.getElementById("reading").textContent.startsWith("Elevation");
    return isThere && (lines[0]?.getAttribute("points").split(" ").length ?? 0) >= count;
  }, wavelengths);
  const text = await page.locator("#reading").innerText();
  const lines = await page.evaluate(() =>
    [...document.querySelectorAll("#spectrum polyline")].map((line) =>
      line.getAttribute("points").split(" ").map((point) => point.split(",").map(Number)),
    ),
  );
  return { text, radiance: Number(/nm: (\S+) W/.exec(text)?.[1]), degree: Number(/polarisation (\S+) %/.exec(text)?.[1]), lines };
}
