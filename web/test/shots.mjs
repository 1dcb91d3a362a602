// Screenshots to look at, into web/out.

import { mkdirSync } from "node:fs";
import { launch, newPage, open } from "./browser.mjs";
import { serve } from "./server.mjs";

const SHOTS = {
  "desktop-sunset": [{ width: 1100, height: 640 }, "projection=perspective&sunElevation=2&pitch=12&field=70&size=320&altitude=2"],
  "desktop-space": [{ width: 1100, height: 640 }, "projection=side&altitude=1500000&sunElevation=8&sunAzimuth=40&size=320"],
  "desktop-moonlit": [{ width: 1100, height: 640 }, "sunElevation=-14&moonElevation=25&moonPhase=30&projection=perspective&pitch=20&size=320"],
  "desktop-hosek": [{ width: 1100, height: 640 }, "projection=lat-long&compare=hosek&sunElevation=8&sunAzimuth=0&size=240"],
  "desktop-ridges": [{ width: 1100, height: 640 }, "projection=perspective&terrain=ridges&sunElevation=14&sunAzimuth=45&pitch=2&field=30&altitude=400&size=320&exposure=13.5"],
  "desktop-polarised": [{ width: 1100, height: 640 }, "quantity=dolp&sunElevation=10&size=320"],
  phone: [{ width: 360, height: 740 }, "sunElevation=8&size=240"],
};

const out = new URL("../out/", import.meta.url).pathname;
mkdirSync(out, { recursive: true });
const server = await serve(new URL("../dist", import.meta.url).pathname);
const browser = await launch();
for (const [name, [size, hash]] of Object.entries(SHOTS)) {
  const { page } = await newPage(browser, size);
  await open(page, server.url, hash);
  await page.locator("#sky").focus();
  await page.keyboard.press("ArrowUp");
  await page.waitForFunction(() => document.getElementById("reading").textContent.startsWith("Elevation"));
  await page.screenshot({ path: `${out}${name}.png` });
  await page.context().close();
}
await browser.close();
server.close();
