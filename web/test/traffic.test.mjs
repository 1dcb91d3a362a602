// What the first picture takes, and what walks through the sliders fetch.

import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { launch, newPage, open } from "./browser.mjs";
import { says } from "./page_text.mjs";
import { serve } from "./server.mjs";
import { csv, markdown, walks } from "./walks.mjs";

const FOLDER = new URL("../dist", import.meta.url).pathname;
const OUT = new URL("../out/", import.meta.url).pathname;

let browser, server;

before(async () => {
  mkdirSync(OUT, { recursive: true });
  server = await serve(FOLDER);
  browser = await launch();
});

after(async () => {
  await browser?.close();
  server?.close();
});

/** CPU milliseconds so far of the browser's processes, but for those of pages: it keeps one more than it needs. */
async function shared(session) {
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  return processInfo.reduce((sum, { type, cpuTime }) => sum + (type === "renderer" ? 0 : 1e3 * cpuTime), 0);
}

/** Of the page's process, its worker included. */
async function own(page) {
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  const { metrics } = await session.send("Performance.getMetrics");
  return 1e3 * metrics.find(({ name }) => name === "ProcessTime").value;
}

test("the first picture comes within a second, of little", async () => {
  const loads = [];
  const session = await browser.newBrowserCDPSession();
  for (let i = 0; i < 3; i++) {
    const { page, complaints } = await newPage(browser);
    server.log.length = 0;
    const before = await shared(session);
    await open(page, server.url, "");
    const spent = (await shared(session)) - before + (await own(page));
    const bytes = (isModel) =>
      server.log.filter(({ name }) => name.endsWith(".welkin") === isModel).reduce((sum, entry) => sum + entry.bytes, 0);
    const milliseconds = await page.evaluate(() => performance.getEntriesByName("first-picture")[0].startTime);
    loads.push({ milliseconds: Math.round(milliseconds), cpu: Math.round(spent), code: bytes(false), model: bytes(true) });
    assert.deepEqual(complaints, []);
    await page.context().close();
  }
  const lines = loads.map((load) => Object.values(load).join(","));
  writeFileSync(`${OUT}first.csv`, `milliseconds,cpu_milliseconds,code_bytes,model_bytes\n${lines.join("\n")}\n`);
  console.log(`  ${lines.join("\n  ")}`);
  assert.ok(loads.every(({ code, model }) => code <= 300_000 && model <= 150_000), lines.join("; "));
  // A machine that has more to do takes longer: there all that the browser does may take that much of a processor.
  assert.ok(Math.min(...loads.map(({ milliseconds, cpu }) => Math.min(milliseconds, cpu))) <= 1000, lines.join("; "));
});

test("walks through the sliders fetch only what is new", async () => {
  const { rows, complaints } = await walks(browser, server);
  writeFileSync(`${OUT}walks.csv`, csv(rows));
  console.log(markdown(rows));
  assert.deepEqual(complaints, []);
  const cheap = rows.filter(({ step }) => /^(sun|albedo)/.test(step));
  assert.ok(cheap.length > 10 && cheap.every(({ requests }) => requests === 0), JSON.stringify(cheap));
  assert.ok(rows.every(({ bytes }) => bytes <= 600_000), JSON.stringify(rows));
  assert.ok(says("walks", markdown(rows)), "README.md says something else: WRITE=1 node --test test/traffic.test.mjs");
});
