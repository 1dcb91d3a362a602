// WebGPU draws what WebGL2 draws, and WebGL2 draws where there is no WebGPU.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, newPage, open, SOFTWARE_WEBGPU } from "./browser.mjs";
import { difference, readExr } from "./reference.mjs";
import { readFileSync } from "node:fs";
import { serve } from "./server.mjs";

const FOLDER = new URL("../dist", import.meta.url).pathname;
const VIEWS = [
  "size=96",
  "size=96&projection=lat-long&sunElevation=4&altitude=3000&disc=shown",
  "size=96&projection=side&sunElevation=-3&tone=filmic&balance=d65&viewAzimuth=40",
  "size=96&quantity=dolp&sunElevation=10",
  "size=97&projection=perspective&polariser=30&pitch=20&tone=linear&exposure=13",
  "size=96&projection=perspective&terrain=ridges&altitude=400&sunElevation=8&sunAzimuth=15&pitch=3&field=40&disc=shown",
  "size=96&projection=up&terrain=ridges&altitude=2&sunElevation=3&disc=shown",
  "size=96&projection=perspective&terrain=ridges&altitude=9000&pitch=-30&ground=black&visibility=30",
];

let server, hasWebGpu = true;
let spoil = () => null;

before(async () => {
  server = await serve(FOLDER, (name) => spoil(name));
});

after(() => server?.close());

const picture = (page) =>
  page.evaluate(async () => {
    const blob = await new Promise((done) => document.getElementById("sky").toBlob(done, "image/png"));
    return btoa(String.fromCharCode(...new Uint8Array(await blob.arrayBuffer())));
  });

const device = (page) => page.evaluate(() => document.documentElement.dataset.gpu);

async function light(page) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#exr").click()]);
  return readExr(readFileSync(await download.path()));
}

test("WebGPU and WebGL2 draw the same", async (t) => {
  const browser = await launch(SOFTWARE_WEBGPU);
  const [gpu, gl] = [await newPage(browser), await newPage(browser)];
  hasWebGpu = await (await (await newPage(browser)).page.goto(server.url), gl.page.goto(server.url)).then(() =>
    gl.page.evaluate(async () => Boolean(await navigator.gpu?.requestAdapter())),
  );
  if (!hasWebGpu) t.skip("this browser has no WebGPU adapter");
  for (const view of hasWebGpu ? VIEWS : []) {
    await t.test(view, async () => {
      await open(gpu.page, server.url, view);
      await open(gl.page, `${server.url}?gpu=webgl`, view);
      assert.deepEqual([await device(gpu.page), await device(gl.page)], ["webgpu", "webgl"]);
      const found = await difference(gpu.page, Buffer.from(await picture(gl.page), "base64"));
      console.log(`  ${view}: mean ${found.mean.toFixed(4)}, largest ${found.most}, level ${found.level.toFixed(0)}`);
      assert.ok(found.most <= 1 && found.level > 2, JSON.stringify(found));
    });
  }
  for (const view of hasWebGpu ? [VIEWS[5]] : []) {
    const [mine, theirs] = [await open(gpu.page, server.url, view).then(() => light(gpu.page)), await open(gl.page, `${server.url}?gpu=webgl`, view).then(() => light(gl.page))];
    const errors = theirs.planes.G.map((value, i) => Math.abs(mine.planes.G[i] / value - 1)).sort();
    console.log(`  EXR: median ${errors[errors.length >> 1].toExponential(1)}, p99 ${errors[Math.floor(0.99 * errors.length)].toExponential(1)}`);
    assert.ok(errors[Math.floor(0.99 * errors.length)] < 1e-3, `${errors.at(-1)}`);
  }
  assert.deepEqual([gpu.complaints, gl.complaints], [[], []]);
  await browser.close();
});

test("without WebGPU, or without its shader, WebGL2 draws", async () => {
  const plain = await launch();
  const { page, complaints } = await newPage(plain);
  await open(page, server.url, VIEWS[0]);
  assert.equal(await device(page), "webgl");
  await open(page, `${server.url}?gpu=webgpu`, VIEWS[0]);
  assert.equal(await device(page), "webgl");
  assert.deepEqual(complaints.filter((line) => !line.includes("No available adapters")), []);
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
