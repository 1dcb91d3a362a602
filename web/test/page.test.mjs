// The page in a browser: what its controls do next to the library's own pictures, what it fetches, and what it says
// when something is wrong.

import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { launch, newPage, open, ready } from "./browser.mjs";
import { compare, enter, SIZE } from "./helpers.mjs";
import { difference, readExr, render } from "./reference.mjs";
import { freeDistance, heights, luminances, pixelDirection } from "./ridges.mjs";
import { serve } from "./server.mjs";

const FOLDER = new URL("../dist", import.meta.url).pathname;
const OUT = new URL("../out/", import.meta.url).pathname;

let browser, server;
let spoil = () => null;

before(async () => {
  mkdirSync(OUT, { recursive: true });
  server = await serve(FOLDER, (name, range) => spoil(name, range));
  browser = await launch();
});

after(async () => {
  await browser?.close();
  server?.close();
});

const PAIRS = [
  [{ sunElevation: 3 }, ["--sun-elevation", "3"]],
  [{ sunElevation: -5 }, ["--sun-elevation", "-5"]],
  [{ sunElevation: 62 }, ["--sun-elevation", "62"]],
  [{ sunAzimuth: 75 }, ["--sun-azimuth", "75"]],
  [{ visibility: 25.3 }, ["--visibility", "25.3"]],
  [{ altitude: 5000 }, ["--altitude", "5000"]],
  [{ altitude: 33000 }, ["--altitude", "33000"]],
  [{ albedo: 0.8 }, ["--albedo", "0.8"]],
  [{ "exposure-none": false, exposure: 14 }, ["--exposure", "14"]],
  [{ viewAzimuth: 40 }, ["--view-azimuth", "40"]],
  [{ projection: "side", viewAzimuth: 20 }, ["--projection", "side", "--view-azimuth", "20", "--ground"]],
  [{ projection: "lat-long", altitude: 2000, ground: "black" }, ["--projection", "lat-long", "--altitude", "2000"]],
  [{ projection: "lat-long", altitude: 2000 }, ["--projection", "lat-long", "--altitude", "2000", "--ground"]],
  [{ projection: "lat-long", altitude: 60000, sunElevation: 4 }, ["--projection", "lat-long", "--altitude", "60000", "--sun-elevation", "4", "--ground"]],
  [{ tone: "linear" }, ["--tone", "linear"]],
  [{ tone: "filmic" }, ["--tone", "filmic"]],
  [{ balance: "d65" }, ["--white-balance", "d65"]],
  [{ quantity: "dolp" }, ["--quantity", "dolp"]],
  [{ quantity: "dolp", projection: "side", sunElevation: 5 }, ["--quantity", "dolp", "--projection", "side", "--sun-elevation", "5"]],
];

test("controls change the picture as the library says", async (t) => {
  const { page, complaints } = await newPage(browser);
  await open(page, server.url, `size=${SIZE}`);
  await compare(page, []);
  for (const [values, args] of PAIRS) {
    await t.test(args.join(" "), async () => {
      await page.locator("#reset").click();
      await open(page, server.url, `size=${SIZE}`);
      await enter(page, values);
      await compare(page, args);
    });
  }
  assert.deepEqual(complaints, []);
  await page.context().close();
});

test("perspective and polariser are the library's above its flat landscape", async () => {
  const { page, complaints } = await newPage(browser);
  const view = ["--terrain", "flat", "--pitch", "15", "--field-of-view", "50", "--view-azimuth", "70", "--exposure", "12.5"];
  // The camera of a landscape stands 2 m high. The horizon is below the lower fifth of the picture.
  const link = `size=${SIZE}&projection=perspective&altitude=2&pitch=15&field=50&viewAzimuth=70&exposure=12.5`;
  await open(page, server.url, link);
  await compare(page, view, { part: 0.75 });
  for (const angle of [0, 35, 90]) {
    await enter(page, { "polariser-none": false, polariser: angle });
    await compare(page, [...view, "--polariser", `${angle}`], { part: 0.75 });
  }
  assert.deepEqual(complaints, []);
  await page.context().close();
});

/** Sum of a plane of an EXR. */
const total = (plane) => plane.reduce((a, b) => a + b, 0);

test("the sun's disc is the library's, however large pixels are", async (t) => {
  const { page, complaints } = await newPage(browser);
  for (const [link, args, part] of [
    ["sunElevation=20", []],
    ["sunElevation=0.1", ["--sun-elevation", "0.1"]],
    ["sunElevation=90", ["--sun-elevation", "90"]],
    ["projection=side&sunElevation=5&altitude=3000", ["--projection", "side", "--sun-elevation", "5", "--altitude", "3000", "--ground"]],
    ["projection=lat-long&sunAzimuth=-180&ground=black", ["--projection", "lat-long", "--sun-azimuth", "-180"]],
    // The disc fills much of this picture, its lower part is behind the horizon, which is below the upper 3/4.
    ["projection=perspective&sunElevation=0.05&pitch=0.25&field=1&altitude=2&exposure=11",
      ["--terrain", "flat", "--sun-elevation", "0.05", "--pitch", "0.25", "--field-of-view", "1", "--altitude", "0", "--exposure", "11"], 0.75],
  ]) {
    await t.test(link, async () => {
      await open(page, server.url, `size=${SIZE}&disc=shown&${link}`);
      await compare(page, ["--sun", ...args], { part });
      const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#exr").click()]);
      const mine = readExr(readFileSync(await download.path()));
      const theirs = readExr(render("exr", ["--size", `${SIZE}`, "--sun", ...args]));
      // What is left of green and blue in the light of a sun that sets is as good as nothing.
      const most = Math.max(...Object.values(theirs.planes).map(total));
      const off = ["R", "G", "B"].map((name) => (total(mine.planes[name]) - total(theirs.planes[name])) / most);
      console.log(`  ${link}: light off by ${off.map((share) => `${(100 * share).toFixed(2)} %`).join(", ")}`);
      assert.ok(off.every((share) => Math.abs(share) < 0.02), `${off}`);
    });
  }
  assert.deepEqual(complaints, []);
  await page.context().close();
});

/** Luminance of the pixels of an EXR. */
const luminance = ({ planes: { R, G, B } }) => R.map((r, i) => 0.2126 * r + 0.7152 * G[i] + 0.0722 * B[i]);

/** Pixels of ridges, away from outlines, with what is seen there. */
function ridgePixels(height, camera, view) {
  const distance = (pixel) => freeDistance(height, camera, pixelDirection(pixel, SIZE, view));
  const found = [];
  for (let row = 3; row < SIZE - 3; row += 5) {
    for (let column = 4; column < 1.5 * SIZE - 4; column += 12) {
      const all = [[0, 0], [-1, -1], [1, -1], [-1, 1], [1, 1]].map(([x, y]) => distance([column + x, row + y]));
      if (Math.max(...all) > 1.1 * Math.min(...all)) continue;
      found.push({ pixel: [column, row], direction: pixelDirection([column, row], SIZE, view), distance: all[0] });
    }
  }
  return found.filter(({ distance }) => distance < 1e5);
}

test("ridges are where they stand, and the air before them is the library's", async (t) => {
  const { page, complaints } = await newPage(browser);
  const height = await heights();
  const take = async () => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#exr").click()]);
    return readExr(readFileSync(await download.path()));
  };
  const base = { altitude: 400, visibility: 59.4, sunElevation: 20, sunAzimuth: 0, viewAzimuth: 30, pitch: 1, field: 20 };
  const levels = [];
  for (const change of [{}, { visibility: 25 }, { sunElevation: 3, sunAzimuth: 100 }, { altitude: 9000, pitch: -12 }]) {
    await t.test(JSON.stringify(change), async () => {
      const view = { ...base, ...change };
      const link = Object.entries(view).map(([key, value]) => `${key}=${value}`).join("&");
      // Ridges that send no light of their own: what is seen is the air before them.
      await open(page, server.url, `size=${SIZE}&projection=perspective&terrain=ridges&ground=black&${link}`);
      const picture = await take();
      const mine = luminance(picture);
      const pixels = ridgePixels(height, view.altitude, view);
      const theirs = luminances(pixels, view);
      const errors = pixels.map(({ pixel: [x, y] }, i) => Math.abs(mine[y * picture.width + x] / theirs[i] - 1)).sort((a, b) => a - b);
      const [median, p95] = [0.5, 0.95].map((share) => errors[Math.floor(share * errors.length)]);
      const far = pixels.map(({ distance }) => distance / 1e3).sort((a, b) => a - b);
      const text = `${JSON.stringify(change)}: ${pixels.length} pixels, ${far[0].toFixed(1)} to ${far.at(-1).toFixed(1)} km, ` +
        `off by ${(100 * median).toFixed(2)} % (median), ${(100 * p95).toFixed(2)} % (p95), ${(100 * errors.at(-1)).toFixed(2)} % (most)`;
      console.log(`  ${text}`);
      assert.ok(pixels.length > 40 && far.at(-1) > 3 * far[0], text);
      assert.ok(median < 0.01 && p95 < 0.04, text);
      levels.push(mine.reduce((a, b) => a + b) / mine.length);
      // In sun and skylight they are brighter, by what the air leaves of that.
      await enter(page, { ground: "lit" });
      const lit = luminance(await take());
      const more = pixels.map(({ pixel: [x, y] }) => lit[y * picture.width + x] - mine[y * picture.width + x]);
      assert.ok(more.every((value) => value > 0), `${Math.min(...more)}`);
    });
  }
  assert.ok(levels.every((level, i) => i === 0 || Math.abs(level / levels[0] - 1) > 0.05), `${levels}`);
  assert.deepEqual(complaints, []);
  await page.context().close();
});

test("a slider moves the picture, and the link brings it back", async () => {
  const { page } = await newPage(browser);
  await open(page, server.url, `size=${SIZE}`);
  await page.locator("#sunElevation-slider").focus();
  for (let i = 0; i < 5; i++) await page.keyboard.press("ArrowRight");
  await ready(page);
  const shown = Number(await page.locator("#sunElevation").inputValue());
  assert.ok(shown > 20, `${shown}`);
  await compare(page, ["--sun-elevation", `${shown}`]);
  await page.locator("#link").click();
  await page.waitForFunction(() => document.getElementById("note").textContent.includes("clipboard"));
  const link = await page.evaluate(() => navigator.clipboard.readText());
  const other = await newPage(browser);
  await other.page.goto(link);
  await ready(other.page);
  assert.equal(Number(await other.page.locator("#sunElevation").inputValue()), shown);
  await compare(other.page, ["--sun-elevation", `${shown}`]);
  await other.page.context().close();
  await page.context().close();
});

test("date, time and place give the library's sun", async () => {
  const { page } = await newPage(browser);
  await open(page, server.url, `size=${SIZE}`);
  await page.locator("summary").click();
  for (const [date, time, latitude, longitude] of [
    ["2026-06-21", "14:30", 48.2, 16.4],
    ["2003-10-17", "19:30", 39.742476, -105.1786],
    ["2026-12-01", "21:10", -33.9, 151.2],
  ]) {
    await page.locator("#instant").fill(`${date}T${time}`);
    await page.locator("#latitude").fill(`${latitude}`);
    await page.locator("#longitude").fill(`${longitude}`);
    await page.locator("#place-sun").click();
    await ready(page);
    const place = ["--latitude", `${latitude}`, "--longitude", `${longitude}`];
    await compare(page, ["--date", date, "--time", `${time}Z`, ...place]);
  }
  await page.context().close();
});

test("PNG and EXR are the picture and its light", async () => {
  const { page } = await newPage(browser);
  await open(page, server.url, `size=${SIZE}&sunElevation=30`);
  const take = async (id) => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`#${id}`).click()]);
    return readFileSync(await download.path());
  };
  const png = await take("png");
  const own = await difference(page, png);
  assert.equal(own.most, 0);
  const mine = readExr(await take("exr"));
  const theirs = readExr(render("exr", ["--size", `${SIZE}`, "--sun-elevation", "30"]));
  assert.deepEqual([mine.width, mine.height], [theirs.width, theirs.height]);
  const errors = [];
  for (const name of ["R", "G", "B"]) {
    mine.planes[name].forEach((value, i) => {
      const truth = theirs.planes[name][i];
      if (truth !== 0) errors.push(Math.abs(value / truth - 1));
    });
  }
  errors.sort((a, b) => a - b);
  const [median, p99] = [0.5, 0.99].map((share) => errors[Math.floor(share * errors.length)]);
  console.log(`  EXR: median ${(100 * median).toFixed(3)} %, p99 ${(100 * p99).toFixed(3)} % of ${errors.length} values`);
  assert.ok(errors.length > 15_000 && median < 0.002 && p99 < 0.01, `${median} ${p99}`);
  await page.context().close();
});

test("the pointer and the keyboard read light and polarisation", async () => {
  const { page, complaints } = await newPage(browser);
  await open(page, server.url, "projection=lat-long");
  await page.locator("#sky").focus();
  await page.keyboard.press("ArrowUp");
  const reading = page.locator("#reading");
  await page.waitForFunction(() => document.getElementById("reading").textContent.startsWith("Elevation"));
  assert.match(await reading.innerText(), /Elevation 3\.6°, azimuth 0\.0°/);
  const before = await page.evaluate(() => document.documentElement.dataset.bytes);
  await page.locator("#full-spectrum").check();
  await page.waitForFunction(() => document.querySelectorAll("#spectrum polyline")[0]?.getAttribute("points").split(" ").length > 100);
  const after = await page.evaluate(() => document.documentElement.dataset.bytes);
  console.log(`  a spectrum streamed ${after - before} bytes`);
  assert.ok(after - before < 400_000);
  const [box] = [await page.locator("#sky").boundingBox()];
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 4);
  await page.waitForFunction(() => document.getElementById("reading").textContent.includes("Elevation 45"));
  const [, shown] = /At 550 nm: (\S+) W/.exec(await reading.innerText());
  const [, degree] = /polarisation (\S+) %/.exec(await reading.innerText());
  const look = /Elevation (\S+)°, azimuth (\S+)°/.exec(await reading.innerText());
  console.log(`  ${look[0]}: ${shown} W m⁻² sr⁻¹ nm⁻¹, ${degree} %`);
  const size = ["--size", "180", "--projection", "lat-long"];
  const at = ({ width, planes }, name) => planes[name][45 * width + 180];
  const exr = readExr(render("exr", [...size, "--quantity", "dolp", "--wavelength", "550"]));
  assert.ok(Math.abs(at(exr, Object.keys(exr.planes)[0]) * 100 - degree) < 0.5, degree);
  assert.deepEqual(complaints, []);
  await page.context().close();
});

test("what is wrong is said, and can be tried again", async (t) => {
  const cases = {
    "no connection": [(name) => name === "/sky.welkin" && { destroy: true }, /no connection to the server/],
    "no file": [(name) => name === "/sky.welkin" && { status: 404 }, /the server says 404/],
    "another file": [(name) => name === "/sky.welkin" && { body: Buffer.alloc(5000, 7) }, /it is no welkin file/],
    "a short file": [(name) => name === "/sky.welkin" && { body: whole.subarray(0, 200_000) }, /shorter or longer|make no sense/],
    "a damaged head": [(name) => name === "/sky.welkin" && { body: damaged(1000) }, /damaged/],
    "a damaged chunk": [(name) => name === "/sky.welkin" && { body: damaged(216_000) }, /damaged/],
    "no code": [(name) => name === "/welkin.wasm" && { status: 404 }, /welkin\.wasm cannot be fetched/],
  };
  const whole = await server.read("sky.welkin");
  const damaged = (at) => {
    const bytes = Buffer.from(whole);
    bytes[at] ^= 255;
    return bytes;
  };
  for (const [name, [answer, words]] of Object.entries(cases)) {
    await t.test(name, async () => {
      const { page, complaints } = await newPage(browser);
      spoil = answer;
      await page.goto(server.url);
      await ready(page, "failed");
      const text = await page.locator("#failure-text").innerText();
      console.log(`  ${name}: ${text}`);
      assert.match(text, words);
      spoil = () => null;
      await page.locator("#retry").click();
      await ready(page);
      assert.equal(await page.locator("#failure").isVisible(), false);
      // The browser itself tells of requests that fail.
      assert.deepEqual(complaints.filter((line) => !line.startsWith("Failed to load resource")), []);
      await page.context().close();
    });
  }
});

test("a connection that is lost later leaves the picture, and comes back", async () => {
  const { page } = await newPage(browser);
  await open(page, server.url, `size=${SIZE}`);
  spoil = (name) => name.endsWith(".welkin") && { destroy: true };
  const altitude = page.locator("#altitude");
  await altitude.fill("3000");
  await altitude.press("Enter");
  await ready(page, "failed");
  assert.match(await page.locator("#failure-text").innerText(), /no connection to the server/);
  await compare(page, []);
  spoil = () => null;
  await page.locator("#retry").click();
  await ready(page);
  await compare(page, ["--altitude", "3000"]);
  await page.context().close();
});

test("a server without ranges sends whole files, and the picture is the same", async () => {
  const { page, complaints } = await newPage(browser);
  spoil = (name) => name.endsWith(".welkin") && { whole: true };
  await open(page, server.url, `size=${SIZE}&altitude=700`);
  spoil = () => null;
  await compare(page, ["--altitude", "700"]);
  assert.equal(await page.evaluate(() => document.documentElement.dataset.requests), "1");
  assert.deepEqual(complaints, []);
  await page.context().close();
});

const RUNS = 15;
const FRAMES = 20;

/** CPU milliseconds of the page's main thread for each frame while a slider moves, all that the browser does there
 * included: the median of runs, as what else the machine does adds to some. */
async function frames(page, id) {
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable", { timeDomain: "threadTicks" });
  const state = async () => {
    const { metrics } = await session.send("Performance.getMetrics");
    return [metrics.find(({ name }) => name === "TaskDuration").value, await page.evaluate(() => globalThis.drawn)];
  };
  const runs = [];
  for (let run = 0; run < RUNS; run++) {
    const before = await state();
    await page.evaluate(
      async ({ id, run, count }) => {
        const slider = document.getElementById(id);
        for (let i = 0; i < count; i++) {
          slider.value = `${0.3 + 0.001 * (count * run + i)}`;
          slider.dispatchEvent(new Event("input"));
          await new Promise(requestAnimationFrame);
        }
      },
      { id, run, count: FRAMES },
    );
    const after = await state();
    runs.push({ drawn: after[1] - before[1], milliseconds: (1e3 * (after[0] - before[0])) / FRAMES });
  }
  await ready(page);
  runs.sort((a, b) => a.milliseconds - b.milliseconds);
  const [least, median, most] = [runs[0], runs[RUNS >> 1], runs.at(-1)].map((run) => run.milliseconds);
  return { least, median, most, drawn: runs.reduce((sum, run) => sum + run.drawn, 0) };
}

test("a frame takes little of the page's thread", async () => {
  const { page } = await newPage(browser);
  await page.addInitScript(() => {
    const { drawArrays } = WebGL2RenderingContext.prototype;
    globalThis.drawn = 0;
    WebGL2RenderingContext.prototype.drawArrays = function (...args) {
      globalThis.drawn++;
      return drawArrays.apply(this, args);
    };
  });
  await open(page, server.url, `size=${SIZE}`);
  const found = { turning: await frames(page, "sunAzimuth-slider"), rising: await frames(page, "sunElevation-slider") };
  const line = ([name, f]) => [name, f.drawn, ...[f.least, f.median, f.most].map((v) => v.toFixed(2))].join(",");
  const lines = Object.entries(found).map(line);
  writeFileSync(`${OUT}frames.csv`, `what,frames,least_cpu_ms_a_frame,median,most\n${lines.join("\n")}\n`);
  console.log(`  ${lines.join("\n  ")}`);
  // Every step of the slider was drawn.
  assert.ok(Object.values(found).every((f) => f.drawn >= RUNS * FRAMES && f.median <= 4), lines.join("; "));
  await page.context().close();
});

test("a phone's width has all of it, named for screen readers", async () => {
  const { page } = await newPage(browser, { width: 360, height: 740 });
  await open(page, server.url, "sunElevation=8");
  const tooWide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  assert.equal(tooWide, false);
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll("input, select, button")]
      .filter((e) => !(e.getAttribute("aria-label") || e.labels?.[0]?.textContent.trim() || e.textContent.trim()))
      .map((e) => e.id),
  );
  assert.deepEqual(nameless, []);
  await page.screenshot({ path: `${OUT}phone.png` });
  await page.context().close();
});
