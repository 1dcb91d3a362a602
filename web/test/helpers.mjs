// What several tests do with a page.

import assert from "node:assert/strict";
import { ready } from "./browser.mjs";
import { difference, render } from "./reference.mjs";

/** Height of the pictures that are compared, pixels. */
export const SIZE = 96;

/** Whether the page's picture is the library's. The models differ (that of the page has fewer wavelengths), the tables
 * are not the library's, and a graphics device has 32 bits. */
export async function compare(page, args, { part = 1, mean = 0.5, p99 = 2 } = {}) {
  const found = await difference(page, render("png", ["--size", `${SIZE}`, ...args]), part);
  const text = `${args.join(" ")}: mean ${found.mean.toFixed(3)}, p99 ${found.p99}, largest ${found.most}, level ${found.level.toFixed(0)}`;
  console.log(`  ${text}`);
  assert.ok(found.mean <= mean && found.p99 <= p99, text);
  assert.ok(found.level > 2, `a black picture says little: ${text}`);
}

/** Enters values as people do. */
export async function enter(page, values) {
  for (const [id, value] of Object.entries(values)) {
    const field = page.locator(`#${id}`);
    const kind = await field.evaluate((e) => (e instanceof HTMLSelectElement ? "list" : e.type));
    if (kind === "list") await field.selectOption(value);
    else if (kind === "checkbox") await field.setChecked(value);
    else {
      await field.fill(`${value}`);
      await field.press("Enter");
      await field.blur();
    }
  }
  await ready(page);
}
