// Three walks through the sliders: what each step fetches.

import { newPage, open } from "./browser.mjs";
import { enter } from "./helpers.mjs";

const HOURS = [-6, -2, 2, 10, 25, 45, 62, 40, 15, 3, -4];
const WALKS = {
  "a day": HOURS.map((sunElevation, i) => ({ sunElevation, sunAzimuth: 150 - 30 * i })),
  weather: [
    { visibility: 100 }, { visibility: 80 }, { visibility: 45 }, { visibility: 30 }, { albedo: 0.6 }, { visibility: 22 },
    { albedo: 0.05 }, { visibility: 59.4 }, { albedo: 0.2 },
  ],
  "a climb": [150, 700, 1500, 3000, 5000, 8000, 12000, 20000, 35000, 60000, 99000].map((altitude) => ({ altitude })),
};

/** Rows of walk, step, requests and bytes; each walk begins with a page that has nothing. */
export async function walks(browser, server) {
  const rows = [];
  const complaints = [];
  for (const [walk, steps] of Object.entries(WALKS)) {
    const { page, complaints: own } = await newPage(browser);
    const take = async (step, action) => {
      server.log.length = 0;
      await action();
      const models = server.log.filter(({ name }) => name.endsWith(".welkin"));
      rows.push({ walk, step, requests: models.length, bytes: models.reduce((sum, { bytes }) => sum + bytes, 0) });
    };
    await take("first picture", () => open(page, server.url, "size=96"));
    for (const values of steps) {
      const step = Object.entries(values).map(([name, value]) => `${name} ${value}`).join(" ");
      await take(step, () => enter(page, values));
    }
    complaints.push(...own);
    await page.context().close();
  }
  return { rows, complaints };
}

export function csv(rows) {
  return ["walk,step,requests,bytes", ...rows.map((row) => Object.values(row).join(",")), ""].join("\n");
}

/** A table of the walks. */
export function markdown(rows) {
  const lines = Object.entries(WALKS).map(([walk, steps]) => {
    const own = rows.filter((row) => row.walk === walk && row.step !== "first picture");
    const sum = (key) => own.reduce((total, row) => total + row[key], 0);
    const most = Math.max(...own.map(({ bytes }) => bytes));
    const kilobytes = (bytes) => (bytes / 1e3).toFixed(0);
    return `| ${walk} | ${steps.length} | ${sum("requests")} | ${kilobytes(sum("bytes"))} | ${kilobytes(most)} |`;
  });
  const { requests, bytes } = rows[0];
  return [
    `The first picture takes ${requests} requests and ${(bytes / 1e3).toFixed(0)} kB of the model; then:`,
    "",
    "| walk | steps | requests | kB | most kB of a step |",
    "| --- | --- | --- | --- | --- |",
    ...lines,
  ].join("\n");
}
