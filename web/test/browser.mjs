// A browser of Debian, and a page in it whose complaints are kept.

import { chromium } from "playwright-core";

const ARGUMENTS = [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
  "--disable-sync", "--disable-gpu-watchdog", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
];

/** A WebGPU device that computes on the processor; without these arguments such a browser has none. */
export const SOFTWARE_WEBGPU = [
  "--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader",
  "--disable-vulkan-surface",
];
/** One that is lost as soon as a canvas shows what it drew: the browser composes pictures with another. */
export const LOST_WEBGPU = SOFTWARE_WEBGPU.slice(0, 2);

export function launch(more = []) {
  const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
  return chromium.launch({ executablePath, headless: true, args: [...ARGUMENTS, ...more] });
}

/** What the browser says, not the page: that it has no WebGPU device for those who ask. */
const OWN = "No available adapters.";

/** A page of this size; `complaints` collects errors of its console and uncaught ones. */
export async function newPage(browser, size = { width: 1200, height: 800 }) {
  const context = await browser.newContext({ viewport: size, permissions: ["clipboard-read", "clipboard-write"] });
  const page = await context.newPage();
  page.setDefaultTimeout(120_000);
  const complaints = [];
  page.on("console", (line) => {
    if (["error", "warning"].includes(line.type()) && line.text() !== OWN) complaints.push(line.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  return { page, complaints };
}

/** Until the page shows what its controls say. */
export async function ready(page, state = "ready") {
  await page.waitForFunction((state) => document.documentElement.dataset.state === state, state);
}

/** Opens a view; `hash` is the part after #. */
export async function open(page, url, hash) {
  await page.goto("about:blank");
  await page.goto(`${url}#${hash}`);
  await ready(page);
}
