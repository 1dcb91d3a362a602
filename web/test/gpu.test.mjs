// WebGPU draws what WebGL2 draws, and WebGL2 draws where there is no WebGPU.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { launch, LOST_WEBGPU, newPage, open, SOFTWARE_WEBGPU } from "./browser.mjs";
import { difference, readExr } from "./reference.mjs";
import { serve } from "./server.mjs";

const FOLDER = new URL("../dist", import.meta.url).pathname;
const VIEWS = [
  "size=96",
  "size=96&projection=lat-long&sunElevation=4&altitude=3000&disc=shown",
  "size=96&projection=side&sunElevation=-3&tone=filmic&balance=d65&viewAzimuth=40",
  "size=96&quantity=dolp&sunElevation=10",
  "size=97&projection=perspective&polariser=30&pitch=20&tone=linear&exposure=13",
  "size=96&projection=perspective&terrain=ridges&altitude=400&sunElevation=8&sunAzimuth=15&pitch=3&field=40&disc=shown",
  "size=96&projection=perspective&terrain=ridges&altitude=9000&pitch=-30&ground=black&visibility=30",
  "size=96&sunElevation=-8&moonElevation=30&moonAzimuth=80&projection=lat-long&polariser=20",
  "size=96&projection=lat-long&altitude=400000&sunElevation=10&sunAzimuth=50",
  "size=96&projection=lat-long&compare=hosek&divider=40&sunElevation=25",
];

let server;
let spoil = () => null;

before(async () => {
  server = await serve(FOLDER, (name) => spoil(name));
});

after(() => server?.close());

const device = (page) => page.evaluate(() => document.documentElement.dataset.gpu);

async function take(page, id) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`#${id}`).click()]);
  return readFileSync(await download.path());
}

/** A page with a view, drawn by a device; `use` gets it. */
async function shown(browser, gpu, view, use) {
  const { page, complaints } = await newPage(browser);
  await open(page, `${server.url}?gpu=${gpu}`, view);
  assert.equal(await device(page), gpu);
  const found = await use(page);
  // That the test reads pixels is no fault of the page.
  assert.deepEqual(complaints.filter((line) => !line.includes("GPU stall due to ReadPixels")), []);
  await page.context().close();
  return found;
}

test("WebGPU and WebGL2 draw the same", async (t) => {
  const browser = await launch(SOFTWARE_WEBGPU);
  const { page } = await newPage(browser);
  await page.goto(server.url);
  const hasWebGpu = await page.evaluate(async () => Boolean(await navigator.gpu?.requestAdapter()));
  await page.context().close();
  if (!hasWebGpu) t.skip("this browser has no WebGPU adapter");
  for (const view of hasWebGpu ? VIEWS : []) {
    await t.test(view, async () => {
      const mine = await shown(browser, "webgpu", view, async (page) => [await take(page, "png"), await take(page, "exr")]);
      await shown(browser, "webgl", view, async (page) => {
        const found = await difference(page, mine[0]);
        const [light, other] = [mine[1], await take(page, "exr")].map((bytes) => readExr(bytes).planes.G);
        const most = other.reduce((a, b) => Math.max(a, b));
        const errors = other.map((value, i) => Math.abs(light[i] - value) / Math.max(value, 1e-6 * most)).sort();
        const p99 = errors[Math.floor(0.99 * errors.length)];
        const text = `${view}: mean ${found.mean.toFixed(4)} levels, largest ${found.most}, of ${found.level.toFixed(0)}; light p99 ${p99.toExponential(1)}`;
        console.log(`  ${text}`);
        assert.ok(found.most <= 1 && found.level > 2 && p99 < 1e-3, text);
      });
    });
  }
  await browser.close();
});

test("without WebGPU, or without its shader, WebGL2 draws", async () => {
  const plain = await launch();
  const { page, complaints } = await newPage(plain);
  await open(page, server.url, VIEWS[0]);
  assert.equal(await device(page), "webgl");
  await open(page, `${server.url}?gpu=webgpu`, VIEWS[0]);
  assert.equal(await device(page), "webgl");
  assert.deepEqual(complaints, []);
  await plain.close();
  const browser = await launch(SOFTWARE_WEBGPU);
  const other = await newPage(browser);
  spoil = (name) => name === "/sky.wgsl" && { status: 404 };
  await open(other.page, server.url, VIEWS[0]);
  assert.equal(await device(other.page), "webgl");
  // A shader that is none.
  spoil = (name) => name === "/sky.wgsl" && { body: Buffer.from("not a shader") };
  await open(other.page, server.url, VIEWS[0]);
  assert.equal(await device(other.page), "webgl");
  spoil = () => null;
  await browser.close();
});

test("when the device is lost, the page starts anew with WebGL2 and the same view", async (t) => {
  const browser = await launch(LOST_WEBGPU);
  const { page } = await newPage(browser);
  await page.goto(`${server.url}#size=96&sunElevation=7&disc=shown`);
  await page.waitForFunction(() => ["webgl", "webgpu"].includes(document.documentElement.dataset.gpu));
  if ((await device(page)) !== "webgpu" && !page.url().includes("gpu=webgl")) return t.skip("this browser has no WebGPU adapter");
  await page.waitForURL(/\?gpu=webgl#/);
  await page.waitForFunction(() => document.documentElement.dataset.state === "ready");
  assert.equal(await device(page), "webgl");
  assert.equal(await page.locator("#sunElevation").inputValue(), "7");
  assert.equal(await page.locator("#failure").isVisible(), false);
  await browser.close();
});
