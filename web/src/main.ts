// The page: a view, the sky that it needs, and what people do with it.

import { byId, Controls } from "./controls";
import { aspect, direction } from "./directions";
import { exr } from "./exr";
import { Failure, message } from "./failure";
import type { Limits, Resolution, Scene, Traffic } from "./protocol";
import { chart, describe } from "./reading";
import { Renderer } from "./renderer";
import { Latest, Skies } from "./skies";
import { sunAt } from "./sun";
import { COARSE_AIR, EYE, FINE_AIR } from "./terrain";
import { fromHash, START, toHash, type View } from "./view";

const FILES = { colours: "sky.welkin", spectra: "default.welkin", code: "welkin.wasm" };
/** While something moves, and when it rests. */
const COARSE: Resolution = [24, 8, 16];
const FINE: Resolution = [48, 24, 32];
/** How long something moves after it moved last, ms. */
const REST = 150;
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
  #shown = "";
  #isMoving = false;
  #rest = 0;
  #frame = 0;
  #measures = 0;
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
    root.dataset["gpu"] = renderer.device;
    this.#controls ??= new Controls(limits, (change, isMoving) => this.change(change, isMoving));
    this.change({}, false);
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
    this.#shown = "";
    if (!this.#limits) {
      this.#skies.close();
      this.#skies = new Skies("worker.js", showTraffic);
      await this.start();
    } else {
      this.#update();
    }
  }

  change(change: Partial<View>, isMoving: boolean): void {
    this.#view = { ...this.#view, ...change };
    this.#isMoving = isMoving;
    clearTimeout(this.#rest);
    if (isMoving) this.#rest = window.setTimeout(() => this.#settle(), REST);
    else history.replaceState(null, "", `#${toHash(this.#view)}`);
    setState("loading");
    this.#update();
  }

  #settle(): void {
    this.change({}, false);
  }

  #scene(): Scene {
    const { sunElevation, visibility, altitude, albedo, ground, disc, quantity, polariser } = this.#view;
    const hasLand = hasLandscape(this.#view);
    return {
      altitude: hasLand ? Math.max(altitude, EYE) : altitude,
      visibility: 1e3 * visibility,
      albedo,
      elevation: (sunElevation * Math.PI) / 180,
      polarised: quantity === "dolp" || polariser !== null,
      // The degree of polarisation is that of the sky's light alone.
      grounded: ground === "lit" && quantity !== "dolp",
      disc: disc === "shown" && quantity !== "dolp",
      air: hasLand ? (this.#isMoving ? COARSE_AIR : FINE_AIR) : null,
      resolution: this.#isMoving ? COARSE : FINE,
    };
  }

  #update(): void {
    this.#draw();
    const renderer = this.#renderer;
    if (!this.#limits || !renderer) return;
    void this.#sky
      .run(async () => {
        const scene = this.#scene();
        const key = JSON.stringify(scene);
        if (scene.air) {
          const land = await this.#skies.land(scene.altitude, scene.elevation, (this.#view.sunAzimuth * Math.PI) / 180);
          renderer.uploadLand(land);
          this.#draw();
        }
        if (key === this.#shown) return;
        const tables = await this.#skies.sky(scene);
        renderer.upload(tables);
        this.#shown = key;
        this.#measure("prepare", tables.prepared);
        this.#measure("bake", tables.baked);
        hideFailure();
        this.#draw();
        this.#read();
      })
      .catch(fail);
  }

  redraw(): void {
    this.#draw();
  }

  /** With the next frame. */
  #draw(): void {
    if (this.#frame !== 0) return;
    this.#frame = requestAnimationFrame(() => {
      this.#frame = 0;
      if (this.#renderer?.hasSky) this.#paint(this.#renderer);
    });
  }

  #paint(renderer: Renderer): void {
    const start = performance.now();
    this.#frameOf(aspect(this.#view.projection));
    renderer.draw(this.#view);
    // What is read, not seen, waits for the rest.
    if (!this.#isMoving) this.#exposure = renderer.exposure(this.#view);
    this.#controls?.show(this.#view, this.#exposure);
    const text = sentence(this.#view, this.#exposure);
    if (!this.#isMoving && scene.textContent !== text) scene.textContent = text;
    this.#measure("draw", performance.now() - start);
    if (performance.getEntriesByName("first-picture").length === 0) performance.mark("first-picture");
    if (!this.#isMoving && this.#sky.isIdle && this.#shown === JSON.stringify(this.#scene())) {
      setState("ready");
    }
  }

  #frameOf(ratio: number): void {
    if (ratio === this.#ratio) return;
    this.#ratio = ratio;
    canvas.style.setProperty("--aspect", `${ratio}`);
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
    if (!where || !this.#limits) return;
    const isSpectral = byId("full-spectrum", HTMLInputElement).checked;
    void this.#look
      .run(async () => {
        const spectrum = await this.#skies.look(this.#scene(), where, isSpectral);
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
    await navigator.clipboard.writeText(link);
    note("The link to this view is on the clipboard.");
  }

  placeSun(): void {
    const [instant, latitude, longitude] = ["instant", "latitude", "longitude"].map((id) => byId(id, HTMLInputElement));
    const date = new Date(`${instant!.value}Z`);
    const place = { latitude: latitude!.valueAsNumber, longitude: longitude!.valueAsNumber };
    if (Number.isNaN(date.getTime()) || !latitude!.checkValidity() || !longitude!.checkValidity()) {
      return note("The sun needs a date, a time, a latitude and a longitude.");
    }
    if (Number.isNaN(place.latitude) || Number.isNaN(place.longitude)) {
      return note("The sun needs a latitude and a longitude.");
    }
    const { elevation, azimuth } = sunAt(date, place);
    const lowest = ((this.#limits?.elevations[0] ?? 0) * 180) / Math.PI;
    if (elevation < lowest) return note(`The sun is ${(-elevation).toFixed(1)}° below the horizon: too deep for the model.`);
    note(`The sun is at ${elevation.toFixed(2)}°, azimuth ${azimuth.toFixed(2)}°.`);
    this.change({ sunElevation: elevation, sunAzimuth: azimuth > 180 ? azimuth - 360 : azimuth }, false);
  }
}

/** The degree of polarisation is that of the sky alone. */
function hasLandscape({ terrain, quantity }: View): boolean {
  return terrain === "ridges" && quantity !== "dolp";
}

function sentence(view: View, exposure: number): string {
  const parts = [
    `sun at ${view.sunElevation.toFixed(1)}°`,
    `visibility ${view.visibility} km`,
    `altitude ${view.altitude} m`,
    `albedo ${view.albedo}`,
    `EV ${exposure.toFixed(1)}`,
    ...(view.polariser === null ? [] : [`polariser at ${view.polariser}°`]),
  ];
  return `${view.quantity === "dolp" ? "Degree of polarisation" : "Clear sky"}: ${parts.join(", ")}`;
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
  on("place-sun", () => page.placeSun());
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
