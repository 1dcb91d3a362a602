// Moonlight, the air from outside, what stands beside the sky, and where the sun stands: next to the library's.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, newPage, open, ready } from "./browser.mjs";
import { compare, enter, SIZE } from "./helpers.mjs";
import { difference, readExr, render, sunOf, turbidityOf } from "./reference.mjs";
import { serve } from "./server.mjs";
import { bundled, download, reading } from "./tools.mjs";

const FOLDER = new URL("../dist", import.meta.url).pathname;

let browser, server;
let spoil = () => null;

before(async () => {
  server = await serve(FOLDER, (name) => spoil(name));
  browser = await launch();
});

after(async () => {
  await browser?.close();
  server?.close();
});

/** A page with a view, and nothing to complain about in the end. */
async function withView(hash, action) {
  const { page, complaints } = await newPage(browser);
  await open(page, server.url, `size=${SIZE}${hash}`);
  await action(page);
  assert.deepEqual(complaints, []);
  await page.context().close();
}

const MOONS = [
  [{ sunElevation: -20, "moonElevation-none": false }, ["--sun-elevation", "-20", "--moon-elevation", "45"]],
  [{ moonElevation: 12, moonAzimuth: 70, moonPhase: 60 }, ["--sun-elevation", "-20", "--moon-elevation", "12", "--moon-azimuth", "70", "--moon-phase", "60"]],
  [{ moonPhase: 120, albedo: 0.7 }, ["--sun-elevation", "-20", "--moon-elevation", "12", "--moon-azimuth", "70", "--moon-phase", "120", "--albedo", "0.7"]],
  // Sun and moon together, each with a share of the light.
  [{ sunElevation: -8.5, sunAzimuth: -40, albedo: 0.2, moonPhase: 5 }, ["--sun-elevation", "-8.5", "--sun-azimuth", "-40", "--moon-elevation", "12", "--moon-azimuth", "70", "--moon-phase", "5"]],
  [{ projection: "lat-long" }, ["--sun-elevation", "-8.5", "--sun-azimuth", "-40", "--moon-elevation", "12", "--moon-azimuth", "70", "--moon-phase", "5", "--projection", "lat-long", "--ground"]],
];

test("moonlight is the library's", () =>
  withView("", async (page) => {
    for (const [values, args] of MOONS) {
      await enter(page, values);
      await compare(page, args);
    }
  }));

test("a sun that is too deep leaves the night, and says so", () =>
  withView("&sunElevation=-30", async (page) => {
    const exr = readExr(await download(page, "exr"));
    assert.ok(exr.planes.G.every((value) => value === 0));
    assert.match(await page.locator("#scene").innerText(), /too deep for its light/);
  }));

const SPACE = [
  ["altitude=100000&projection=lat-long", ["--altitude", "100000", "--projection", "lat-long"]],
  ["altitude=400000&projection=lat-long&sunAzimuth=50", ["--altitude", "400000", "--projection", "lat-long", "--sun-azimuth", "50"]],
  ["altitude=400000&projection=lat-long&sunElevation=-5", ["--altitude", "400000", "--projection", "lat-long", "--sun-elevation", "-5"]],
  ["altitude=2500000&projection=lat-long&sunElevation=55&visibility=30", ["--altitude", "2500000", "--projection", "lat-long", "--sun-elevation", "55", "--visibility", "30"]],
  ["altitude=5000000&projection=lat-long&sunElevation=-14&ground=black", ["--altitude", "5000000", "--projection", "lat-long", "--sun-elevation", "-14"]],
  ["altitude=800000&projection=side&ground=black", ["--altitude", "800000", "--projection", "side"]],
];

test("the air from outside is the library's", () =>
  withView("", async (page) => {
    for (const [hash, args] of SPACE) {
      await open(page, server.url, `size=${SIZE}&${hash}`);
      await compare(page, hash.includes("black") ? args : [...args, "--ground"]);
    }
  }));

/** Red, green and blue of another reader of the authors' data: `sunsky` of Mitsuba 3.9 (turbidity 3, albedo 0.2, no
 * sun) at solar elevation, zenith angle and azimuth, degrees; in radiance over 106.857 nm. */
const HOSEK = [
  [60, 5, 90, [0.0346231, 0.0532377, 0.10054]],
  [60, 80, 180, [0.0834626, 0.134677, 0.216412]],
  [20, 55, 90, [0.025732, 0.0459703, 0.0756899]],
  [5, 5, 90, [0.00671738, 0.0121455, 0.0182968]],
  [5, 80, 180, [0.0680586, 0.0755943, 0.0612984]],
];
const HEIGHT = 360;

test("Hosek and Wilkie's sky is that of another reader of their data", () =>
  withView("", async (page) => {
    const visibility = turbidityOf({ turbidity: 3 });
    for (const [elevation, zenith, azimuth, expected] of HOSEK) {
      const view = `size=${HEIGHT}&projection=lat-long&sunElevation=${elevation}&albedo=0.2&visibility=${visibility}`;
      await open(page, server.url, `${view}&compare=hosek&divider=0`);
      const { width, planes } = readExr(await download(page, "exr"));
      // Between the pixels that the place is next to.
      const [x, y] = [width / 2 - (azimuth / 360) * width, (zenith / 180) * HEIGHT].map(Math.round);
      const near = (plane) => {
        const at = [[-1, -1], [0, -1], [-1, 0], [0, 0]].map(([i, j]) => plane[(y + j) * width + ((x + i + width) % width)]);
        return at.reduce((a, b) => a + b) / 4;
      };
      const rgb = ["R", "G", "B"].map((name) => near(planes[name]) / 683 / 106.857);
      const errors = rgb.map((value, i) => value / expected[i] - 1);
      console.log(`  ${elevation}° ${zenith}°: ${errors.map((e) => `${(100 * e).toFixed(2)} %`).join(", ")}`);
      // The turbidity is rounded, too.
      assert.ok(errors.every((error) => Math.abs(error) < 0.02), `${rgb}`);
    }
  }));

test("the divider parts the picture, by slider and by hand", () =>
  withView("&projection=lat-long&exposure=13", async (page) => {
    const alone = await download(page, "png");
    await enter(page, { compare: "hosek", divider: 25 });
    const { width, planes } = readExr(await download(page, "exr"));
    const whole = readExr(render("exr", ["--size", `${SIZE}`, "--projection", "lat-long"]));
    const row = Math.floor(SIZE / 4) * width;
    const same = [...Array(width).keys()].filter((x) => Math.abs(planes.G[row + x] / whole.planes.G[row + x] - 1) < 0.02);
    assert.ok(same.filter((x) => x < width / 4).length === width / 4, `${same}`);
    assert.ok(same.filter((x) => x >= width / 4).length < width / 4, `${same}`);
    assert.match(await page.locator("#scene").innerText(), /At the right Hosek and Wilkie 2012 .*turbidity 2\.1/);
    const box = await page.locator("#divider-handle").boundingBox();
    const frame = await page.locator("#frame").boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + 20);
    await page.mouse.down();
    await page.mouse.move(frame.x + 0.75 * frame.width, box.y + 20, { steps: 5 });
    await page.mouse.up();
    await ready(page);
    assert.ok(Math.abs(Number(await page.locator("#divider").inputValue()) - 75) < 1);
    await enter(page, { compare: "none" });
    assert.equal((await difference(page, alone)).most, 0);
    await enter(page, { compare: "hosek", sunElevation: -3 });
    assert.match(await page.locator("#scene").innerText(), /no sky for a sun below the horizon/);
  }));

test("data of Hosek and Wilkie that are not there are said to be so, and can be tried again", async () => {
  const { page, complaints } = await newPage(browser);
  spoil = (name) => name === "/hosek.bin" && { status: 404 };
  await page.goto(`${server.url}#size=${SIZE}&compare=hosek`);
  await ready(page, "failed");
  assert.match(await page.locator("#failure-text").innerText(), /Hosek and Wilkie cannot be fetched: the server says 404/);
  spoil = () => null;
  await page.locator("#retry").click();
  await ready(page);
  assert.match(await page.locator("#scene").innerText(), /turbidity/);
  assert.deepEqual(complaints.filter((line) => !line.startsWith("Failed to load resource")), []);
  await page.context().close();
});

test("turbidities are the library's", () =>
  withView("&compare=hosek", async (page) => {
    for (const turbidity of [1.7, 2.5, 4]) {
      await enter(page, { visibility: turbidityOf({ turbidity }) });
      const [, shown] = /turbidity ([\d.]+)/.exec(await page.locator("#scene").innerText());
      assert.ok(Math.abs(shown - turbidity) < 0.02, `${shown} for ${turbidity}`);
    }
  }));

test("what is under the pointer is the library's, for each light and from outside", async () => {
  const size = ["--size", "180", "--projection", "lat-long", "--spectral"];
  const pixel = (args, name) => {
    const { width, planes } = readExr(render("exr", [...size, ...args]));
    const [found] = Object.keys(planes).filter((key) => key.includes(name));
    return planes[found][45 * width + 180];
  };
  for (const [hash, args] of [
    ["sunAzimuth=75", ["--sun-azimuth", "75"]],
    ["sunElevation=-20&moonElevation=30&moonAzimuth=-50", ["--sun-elevation", "-20", "--moon-elevation", "30", "--moon-azimuth", "-50"]],
    ["sunElevation=-7&moonElevation=30&moonAzimuth=-50", ["--sun-elevation", "-7", "--moon-elevation", "30", "--moon-azimuth", "-50"]],
  ]) {
    await withView(`&projection=lat-long&${hash}`, async (page) => {
      const found = await reading(page, [0.5 + 0.5 / 360, 0.25 + 0.5 / 180]);
      const expected = pixel(args, "550");
      console.log(`  ${hash}: ${found.radiance} of ${expected}`);
      assert.ok(Math.abs(found.radiance / expected - 1) < 0.02, `${found.radiance} of ${expected}`);
    });
  }
});

test("the spectrum has all wavelengths, with their polarisation", () =>
  withView("&projection=lat-long&sunAzimuth=75", async (page) => {
    await page.locator("#full-spectrum").check();
    const found = await reading(page, [0.5 + 0.5 / 360, 0.25 + 0.5 / 180], 100);
    const [radiance, degree] = found.lines;
    const size = ["--size", "180", "--projection", "lat-long", "--sun-azimuth", "75"];
    // The chart's axis is from 300 to 1100 nm.
    const shown = (line, wavelength) => {
      const x = 18 + ((wavelength - 300) / 800) * 284;
      return line.find(([at]) => Math.abs(at - x) < 0.1)?.[1];
    };
    const share = (y) => (102 - y) / 84;
    for (const wavelength of [400, 550, 700]) {
      const exr = readExr(render("exr", [...size, "--quantity", "dolp", "--wavelength", `${wavelength}`]));
      const expected = Object.values(exr.planes)[0][45 * exr.width + 180];
      console.log(`  ${wavelength} nm: ${share(shown(degree, wavelength)).toFixed(3)} of ${expected.toFixed(3)}`);
      assert.ok(Math.abs(share(shown(degree, wavelength)) - expected) < 0.01, `${wavelength}`);
      assert.ok(share(shown(radiance, wavelength)) > 0.05);
    }
  }));

test("the moon of a date is that of Meeus's example", async () => {
  // Example 47.a: 1992 April 12, 0 h of the orbits' time.
  const { ecliptic, moonAt } = await bundled("moon.ts");
  const { longitude, latitude, distance } = ecliptic(-0.077221081451);
  const turned = ((longitude % 360) + 360) % 360;
  console.log(`  ${turned.toFixed(4)}°, ${latitude.toFixed(4)}°, ${distance.toFixed(0)} km`);
  assert.ok(Math.abs(turned - 133.162655) < 0.02 && Math.abs(latitude + 3.229126) < 0.02, `${turned} ${latitude}`);
  assert.ok(Math.abs(distance - 368409.7) < 100, `${distance}`);
  // An eclipse of the sun, 12 August 2026, 18:30 in the north of Spain: the discs overlap.
  const [instant, place] = [new Date("2026-08-12T18:29Z"), { latitude: 42.6, longitude: -5.6 }];
  const { sunAt } = await bundled("sun.ts");
  const [sun, moon] = [sunAt(instant, place), moonAt(instant, place)];
  const apart = Math.hypot(sun.elevation - moon.elevation, (sun.azimuth - moon.azimuth) * Math.cos((sun.elevation * Math.PI) / 180));
  console.log(`  ${apart.toFixed(3)}° from the sun, phase angle ${moon.phase.toFixed(2)}°`);
  assert.ok(apart < 0.1 && moon.phase > 178);
});

test("the sun of a date is the command's to 0.02°", async () => {
  const { sunAt } = await bundled("sun.ts");
  let most = 0;
  for (const [date, time] of [
    ["1990-03-21", "06:00"], ["2003-10-17", "19:30"], ["2026-06-21", "12:00"], ["2026-12-01", "21:10"], ["2049-02-11", "03:45"],
  ]) {
    for (const [latitude, longitude] of [[48.2, 16.4], [-33.9, 151.2], [0, -78.5], [69.6, 18.9], [-77.8, 166.7]]) {
      const mine = sunAt(new Date(`${date}T${time}Z`), { latitude, longitude });
      const theirs = sunOf({ date, time: `${time}Z`, latitude, longitude });
      if (!theirs) continue; // below what the model has
      const turn = ((mine.azimuth - theirs.azimuth + 540) % 360) - 180;
      const off = Math.max(Math.abs(mine.elevation - theirs.elevation), Math.abs(turn * Math.cos((mine.elevation * Math.PI) / 180)));
      most = Math.max(most, off);
      assert.ok(off <= 0.02, `${date} ${time} at ${latitude} ${longitude}: ${off}°`);
    }
  }
  console.log(`  at most ${most.toFixed(4)}° off`);
  assert.ok(most > 0);
});
