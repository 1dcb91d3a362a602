// The page: a view, the sky that it needs, and what people do with it.

import { Beside, Divider, type Other } from "./beside";
import { byId, Controls } from "./controls";
import { aspect, direction } from "./directions";
import { exr } from "./exr";
import { Failure, message } from "./failure";
import type { Limits, Resolution, SkyTables, Traffic } from "./protocol";
import { chart, describe } from "./reading";
import { Renderer } from "./renderer";
import { Latest, Skies } from "./skies";
import { moonAt } from "./moon";
import { sunAt } from "./sun";
import { fromHash, START, toHash, type View } from "./view";
import { COARSE, FINE, isSame, isSameScene, looks, SOURCES, type Wanted, wanted } from "./wanted";

const FILES = { colours: "sky.welkin", spectra: "default.welkin", code: "welkin.wasm" };
const HOSEK = "hosek.bin";
/** How long something moves after it moved last, ms. */
const REST = 150;
/** Numbers that nobody reads so fast wait that long while something moves, ms: text costs the browser a layout. */
const READING = 100;
/** Measures that the browser keeps. */
const MOST_MEASURES = 2000;

const canvas = byId("sky", HTMLCanvasElement);
const scene = byId("scene", HTMLElement);
const root = document.documentElement;

function setState(state: "loading" | "ready" | "failed"): void {
  if (root.dataset["state"] !== state) root.dataset["state"] = state;
}

class Page {
  #view: View;
  #limits: Limits | null = null;
  #controls: Controls | null = null;
  #skies: Skies;
  #renderer: Renderer | null = null;
  readonly #sky = new Latest();
  readonly #look = new Latest();
  readonly #beside = new Beside(HOSEK);
  #divider: Divider | null = null;
  #shown: Wanted | null = null;
  #other: Other | null = null;
  #isMoving = false;
  #moved = 0;
  #rest = 0;
  #written = 0;
  #frame = 0;
  #measures = 0;
  #hasPicture = false;
  #ratio = 1;
  #exposure = 0;
  #place: [number, number] | null = null;

  constructor() {
    const { view, wrong } = fromHash(location.hash);
    this.#view = view;
    if (wrong.length > 0) note(`Not understood in the link: ${wrong.join(", ")}`);
    this.#skies = new Skies("worker.js", showTraffic);
  }

  async start(): Promise<void> {
    const [limits, renderer] = await Promise.all([this.#skies.open(FILES), this.#renderer ?? this.#device()]);
    this.#limits = limits;
    this.#renderer = renderer;
    this.#clampVisibility(limits);
    root.dataset["gpu"] = renderer.device;
    const change = (change: Partial<View>, isMoving: boolean) => this.change(change, isMoving);
    this.#controls ??= new Controls(limits, change);
    this.#divider ??= new Divider(change);
    this.change({}, false);
  }

  /** A link may ask for air that the model does not have. */
  #clampVisibility({ visibilities }: Limits): void {
    const [low, high] = [visibilities[0]! / 1e3, visibilities.at(-1)! / 1e3];
    const wished = this.#view.visibility;
    this.#view.visibility = Math.min(Math.max(wished, low), high);
    if (this.#view.visibility !== wished) note(`The model's visibilities are ${low} to ${high} km, not ${wished} km.`);
  }

  #device(): Promise<Renderer> {
    const wanted = new URLSearchParams(location.search).get("gpu");
    // A canvas that drew with one device does not draw with another: the page starts anew, with the same view.
    const onLost = () => {
      const address = new URL(location.href);
      address.searchParams.set("gpu", "webgl");
      address.hash = toHash(this.#view);
      location.replace(address);
    };
    return Renderer.create(canvas, wanted, onLost);
  }

  /** Starts anew after a failure. */
  async retry(): Promise<void> {
    hideFailure();
    this.#shown = null;
    if (!this.#limits) {
      this.#skies.close();
      this.#skies = new Skies("worker.js", showTraffic);
      await this.start();
    } else {
      this.#update();
    }
  }

  change(change: Partial<View>, isMoving: boolean): void {
    Object.assign(this.#view, change);
    this.#isMoving = isMoving;
    this.#moved = performance.now();
    if (isMoving) this.#rest ||= window.setTimeout(this.#settle, REST);
    else history.replaceState(null, "", `#${toHash(this.#view)}`);
    setState("loading");
    this.#update();
  }

  /** Where nothing moved for a while, and for two frames, which may take longer. */
  readonly #settle = (): void => {
    const moved = this.#moved;
    this.#rest = 0;
    requestAnimationFrame(() =>
      requestAnimationFrame(() => {
        if (!this.#isMoving) return;
        if (this.#moved === moved && performance.now() - moved >= REST) this.change({}, false);
        else this.#rest ||= window.setTimeout(this.#settle, REST);
      }),
    );
  };

  #wanted(limits: Limits): Wanted {
    return wanted(this.#view, limits, this.#resolution);
  }

  get #resolution(): Resolution {
    return this.#isMoving ? COARSE : FINE;
  }

  #update(): void {
    this.#draw();
    const limits = this.#limits;
    const renderer = this.#renderer;
    if (limits && renderer) void this.#sky.run(() => this.#fetch(limits, renderer)).catch(fail);
  }

  /** What is not there yet; all of it is shown at once. */
  async #fetch(limits: Limits, renderer: Renderer): Promise<void> {
    const now = this.#wanted(limits);
    const before = this.#shown;
    if (isSame(now, before)) {
      hideFailure();
      // The camera may have turned.
      if (!this.#isMoving) this.#read();
      return;
    }
    const other = now.other === before?.other ? this.#other : await this.#beside.of({ ...this.#view }, this.#skies);
    const changed = SOURCES.filter((source) => before === null || !isSameScene(now[source], before[source]));
    const tables: (SkyTables | null)[] = [];
    for (const source of changed) tables.push(now[source] && (await this.#skies.sky(now[source])));
    const land = now.land && (await this.#skies.land(now.land.altitude, now.land.elevation, now.land.azimuth));
    if (land) renderer.uploadLand(land);
    changed.forEach((source, i) => renderer.set(source, tables[i]!));
    renderer.place(now.eye);
    renderer.beside(other?.coefficients ?? null);
    this.#other = other;
    this.#shown = now;
    for (const table of tables) if (table) this.#measure("prepare", table.prepared);
    for (const table of tables) if (table) this.#measure("bake", table.baked);
    hideFailure();
    this.#draw();
    this.#read();
  }

  redraw(): void {
    this.#draw();
  }

  /** With the next frame. */
  #draw(): void {
    if (this.#frame === 0) this.#frame = requestAnimationFrame(this.#paint);
  }

  readonly #paint = (): void => {
    this.#frame = 0;
    const renderer = this.#renderer;
    if (!renderer?.hasSky) return;
    this.#frameOf(aspect(this.#view.projection));
    renderer.draw(this.#view);
    this.#divider?.show(this.#view.compare !== "none" && this.#shown?.eye === null, this.#view.divider);
    const now = performance.now();
    if (!this.#isMoving || now - this.#written >= READING) this.#write(now, renderer);
    if (!this.#hasPicture) performance.mark("first-picture");
    this.#hasPicture = true;
    if (this.#isMoving || !this.#sky.isIdle || !this.#isCurrent()) return;
    if (renderer.isMetered(this.#view)) setState("ready");
    else void renderer.meter({ ...this.#view }).then(() => this.#draw(), fail);
  };

  #isCurrent(): boolean {
    return this.#limits !== null && isSame(this.#wanted(this.#limits), this.#shown);
  }

  /** What is read, not seen. */
  #write(now: number, renderer: Renderer): void {
    this.#written = now;
    if (!this.#isMoving) this.#exposure = renderer.exposure(this.#view);
    this.#controls?.show(this.#view, this.#exposure);
    if (this.#isMoving) return;
    const text = sentence(this.#view, this.#exposure, this.#shown, this.#other);
    if (scene.textContent !== text) scene.textContent = text;
  }

  #frameOf(ratio: number): void {
    if (ratio === this.#ratio) return;
    this.#ratio = ratio;
    byId("frame", HTMLElement).style.setProperty("--aspect", `${ratio}`);
  }

  #measure(name: string, duration: number): void {
    if (++this.#measures > MOST_MEASURES) {
      performance.clearMeasures();
      this.#measures = 0;
    }
    performance.measure(name, { start: performance.now() - duration, duration });
  }

  /** What is at a place of the canvas, both coordinates −1 to 1 to the right and upwards. */
  point(place: [number, number]): void {
    this.#place = place;
    this.#read();
  }

  get place(): [number, number] {
    return this.#place ?? [0, 0];
  }

  #read(): void {
    const where = this.#place && direction(this.#view, ...this.#place);
    const limits = this.#limits;
    if (!where || !limits) return;
    const isSpectral = byId("full-spectrum", HTMLInputElement).checked;
    void this.#look
      .run(async () => {
        const spectrum = await this.#skies.look(looks(this.#view, limits, FINE, where), isSpectral);
        byId("reading", HTMLElement).textContent = describe(where, spectrum);
        chart(byId("spectrum", SVGSVGElement), spectrum);
      })
      .catch(fail);
  }

  png(): void {
    if (!this.#renderer?.hasSky) return note("There is no picture yet.");
    this.#renderer.draw(this.#view);
    canvas.toBlob((blob) => (blob ? save(blob, "sky.png") : note("The browser made no PNG.")), "image/png");
  }

  async exr(): Promise<void> {
    if (!this.#renderer?.hasSky) return note("There is no picture yet.");
    save(new Blob([exr(await this.#renderer.light(this.#view))], { type: "image/x-exr" }), "sky.exr");
  }

  async link(): Promise<void> {
    const link = new URL(`#${toHash(this.#view)}`, location.href).href;
    history.replaceState(null, "", link);
    try {
      await navigator.clipboard.writeText(link);
      note("The link to this view is on the clipboard.");
    } catch {
      // Only pages that came over https, or from this machine, may write there.
      note(`The browser gives no clipboard here. The link is in the address bar: ${link}`);
    }
  }

  /** Where they stand at a date, a time and a place. */
  placeLights(hasMoon: boolean): void {
    const [instant, latitude, longitude] = ["instant", "latitude", "longitude"].map((id) => byId(id, HTMLInputElement));
    const date = new Date(`${instant!.value}Z`);
    const place = { latitude: latitude!.valueAsNumber, longitude: longitude!.valueAsNumber };
    if (Number.isNaN(date.getTime()) || Number.isNaN(place.latitude) || Number.isNaN(place.longitude)) {
      return note("The sun needs a date, a time, a latitude and a longitude.");
    }
    if (!latitude!.checkValidity() || !longitude!.checkValidity()) {
      return note("Latitudes are within ±90°, longitudes within ±180°.");
    }
    const { elevation, azimuth } = sunAt(date, place);
    const lowest = ((this.#limits?.elevations[0] ?? 0) * 180) / Math.PI;
    const short = (angle: number) => Number(angle.toFixed(4));
    const signed = (azimuth: number) => short(azimuth > 180 ? azimuth - 360 : azimuth);
    const moon = hasMoon ? moonAt(date, place) : null;
    const depth = elevation < lowest ? ": too deep for its light" : "";
    note(`The sun is at ${elevation.toFixed(2)}°, azimuth ${azimuth.toFixed(2)}°${depth}${moon ? `, the moon at ${moon.elevation.toFixed(1)}°` : ""}.`);
    this.change(
      {
        sunElevation: short(elevation),
        sunAzimuth: signed(azimuth),
        ...(moon && { moonElevation: short(moon.elevation), moonAzimuth: signed(moon.azimuth), moonPhase: short(moon.phase) }),
      },
      false,
    );
  }
}

function sentence(view: View, exposure: number, shown: Wanted | null, other: Other | null): string {
  const { moonElevation, moonPhase, polariser } = view;
  const isBeyond = shown !== null && shown.eye !== null;
  const isDark = shown !== null && !isBeyond && shown.sun === null;
  const parts = [
    `sun at ${view.sunElevation.toFixed(1)}°${isDark ? ", too deep for its light" : ""}`,
    ...(moonElevation === null || isBeyond ? [] : [`moon at ${moonElevation.toFixed(1)}°, phase angle ${Number(moonPhase.toFixed(2))}°`]),
    `visibility ${view.visibility} km`,
    `altitude ${view.altitude} m`,
    `albedo ${view.albedo}`,
    `EV ${exposure.toFixed(1)}`,
    ...(polariser === null || isBeyond ? [] : [`polariser at ${polariser}°`]),
  ];
  const what = view.quantity === "dolp" && !isBeyond ? "Degree of polarisation" : "Clear sky";
  return `${isBeyond ? "From outside of the air, in colour only" : what}: ${parts.join(", ")}${beside(view, isBeyond, other)}`;
}

function beside({ sunElevation }: View, isBeyond: boolean, other: Other | null): string {
  if (!other || isBeyond) return "";
  if (sunElevation < 0) return ". Hosek and Wilkie, at the right, have no sky for a sun below the horizon";
  return `. At the right Hosek and Wilkie 2012 on the ground, turbidity ${other.turbidity.toFixed(2)}`;
}

function showTraffic({ requests, bytes, total }: Traffic): void {
  const kilobytes = (count: number) => `${(count / 1e3).toFixed(0)} kB`;
  byId("traffic", HTMLElement).textContent =
    `${requests} requests, ${kilobytes(bytes)} of models that are ${kilobytes(total)}`;
  Object.assign(root.dataset, { requests, bytes });
}

function note(text: string): void {
  byId("note", HTMLOutputElement).textContent = text;
}

function save(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function fail(error: unknown): void {
  byId("failure-text", HTMLElement).textContent = message(error);
  byId("failure", HTMLElement).hidden = false;
  setState("failed");
}

function hideFailure(): void {
  byId("failure", HTMLElement).hidden = true;
}

/** The arrow keys move what is under the pointer. */
function onKey(page: Page, event: KeyboardEvent): void {
  const steps: Record<string, [number, number]> = {
    ArrowLeft: [-1, 0],
    ArrowRight: [1, 0],
    ArrowUp: [0, 1],
    ArrowDown: [0, -1],
  };
  const step = steps[event.key];
  if (!step) return;
  event.preventDefault();
  const [x, y] = page.place;
  const size = event.shiftKey ? 0.2 : 0.04;
  const within = (value: number) => Math.min(Math.max(value, -1), 1);
  page.point([within(x + size * step[0]), within(y + size * step[1])]);
}

function listen(page: Page): void {
  const on = (id: string, action: () => unknown) =>
    byId(id, HTMLButtonElement).addEventListener("click", () => void Promise.resolve().then(action).catch(fail));
  on("retry", () => page.retry());
  on("link", () => page.link());
  on("png", () => page.png());
  on("exr", () => page.exr());
  on("place-sun", () => page.placeLights(false));
  on("place-both", () => page.placeLights(true));
  byId("controls", HTMLFormElement).addEventListener("submit", (event) => event.preventDefault());
  byId("full-spectrum", HTMLInputElement).addEventListener("change", () => page.point(page.place));
  canvas.addEventListener("keydown", (event) => onKey(page, event));
  canvas.addEventListener("redraw", () => page.redraw());
  canvas.addEventListener("pointermove", ({ offsetX, offsetY }) => {
    page.point([(2 * offsetX) / canvas.clientWidth - 1, 1 - (2 * offsetY) / canvas.clientHeight]);
  });
  addEventListener("hashchange", () => {
    const { view, wrong } = fromHash(location.hash);
    if (wrong.length > 0) note(`Not understood in the link: ${wrong.join(", ")}`);
    page.change({ ...START, ...view }, false);
  });
}

try {
  const page = new Page();
  listen(page);
  page.start().catch(fail);
} catch (error) {
  fail(error instanceof Failure ? error : new Failure(message(error)));
}
