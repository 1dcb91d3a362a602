// What people stumbled over: keys that moved nothing, links that were not the model's, readings of another camera.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, newPage, open, ready } from "./browser.mjs";
import { enter, SIZE } from "./helpers.mjs";
import { serve } from "./server.mjs";

const FOLDER = new URL("../dist", import.meta.url).pathname;
let browser, server;
let spoil = () => null;

before(async () => {
  server = await serve(FOLDER, (name, range) => spoil(name, range));
  browser = await launch();
});

after(async () => {
  await browser?.close();
  server?.close();
});

test("a link's odd words are named, and its air is the model's", async () => {
  const { page, complaints } = await newPage(browser);
  await open(page, server.url, `size=${SIZE}&toString=1`);
  assert.match(await page.locator("#note").innerText(), /toString=1/);
  await page.goto("about:blank");
  await open(page, server.url, `size=${SIZE}&visibility=500`);
  assert.match(await page.locator("#note").innerText(), /not 500 km/);
  assert.ok(Number(await page.locator("#visibility").inputValue()) < 200);
  assert.deepEqual(complaints, []);
  await page.context().close();
});

test("a key moves every slider", async () => {
  const { page } = await newPage(browser);
  await open(page, server.url, `size=${SIZE}`);
  await enter(page, { altitude: 1000, albedo: 0.5 });
  for (const id of ["altitude", "albedo", "visibility", "sunElevation"]) {
    const value = async () => Number(await page.locator(`#${id}`).inputValue());
    const start = await value();
    await page.locator(`#${id}-slider`).focus();
    await page.keyboard.press("ArrowRight");
    await ready(page);
    const more = await value();
    assert.ok(more > start, `${id}: ${start} ${more}`);
    await page.keyboard.press("ArrowLeft");
    await ready(page);
    assert.ok((await value()) < more, id);
  }
  await page.context().close();
});

test("the reading is that of the camera", async () => {
  const { page } = await newPage(browser);
  await open(page, server.url, `size=${SIZE}&projection=perspective&sunElevation=10`);
  await page.locator("#sky").focus();
  await page.keyboard.press("ArrowUp");
  const reading = () => page.locator("#reading").innerText();
  await page.waitForFunction(() => /azimuth/.test(document.getElementById("reading").textContent));
  const before = await reading();
  await enter(page, { viewAzimuth: 90 });
  await page.waitForFunction((text) => document.getElementById("reading").innerText !== text, before);
  assert.match(await reading(), /azimuth 90/);
  await page.context().close();
});

test("a failure is forgotten when its cause is taken back", async () => {
  const { page } = await newPage(browser);
  await open(page, server.url, `size=${SIZE}`);
  spoil = () => ({ status: 404 });
  await page.locator("#visibility").fill("25");
  await page.locator("#visibility").press("Enter");
  await page.locator("#failure").waitFor({ state: "visible" });
  const { y } = await page.locator("#failure").boundingBox();
  assert.ok(y >= 0 && y < 200, `${y}`);
  spoil = () => null;
  await enter(page, { visibility: 59.4 });
  await page.locator("#failure").waitFor({ state: "hidden" });
  await page.context().close();
});
