// Draws the sky: with WebGPU where there is such a device, else with WebGL2.

import { aspect } from "./directions";
import type { Device } from "./gpu/device";
import { WebGL } from "./gpu/webgl";
import { WebGPU } from "./gpu/webgpu";
import type { Coefficients } from "./hosek";
import { type Eye, landTextures, skyTextures, type Source, values } from "./inputs";
import { WHITE_AT_EV_0, whiteOfPixels, whiteOfSky } from "./metering";
import type { SkyTables } from "./protocol";
import type { Land } from "./terrain";
import { TONES, type View } from "./view";

const RADIANS = Math.PI / 180;
/** What is seen from space is exposed by a picture of that height at most. */
const METERED = 128;
const SHADER = "sky.wgsl";

export interface Pixels {
  width: number;
  height: number;
  /** R, G, B and 1, cd m⁻², from the bottom up. */
  light: Float32Array;
}

export class Renderer {
  readonly #tables = new Map<Source, SkyTables>();
  #isReady = false;
  #eye: Eye = null;
  #other: Coefficients | null = null;
  /** White where it is automatic, cd m⁻², and the azimuth between the lights, or the view from space, that it is for. */
  #white = WHITE_AT_EV_0;
  #between = NaN;
  #metered = "";
  #hasLand = false;
  /** Of the canvas on the page; to ask it in each frame would lay the page out each time. */
  #cssHeight: number;

  private constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly drawing: Device,
  ) {
    this.#cssHeight = canvas.clientHeight;
    new ResizeObserver(() => {
      this.#cssHeight = canvas.clientHeight;
      canvas.dispatchEvent(new Event("redraw"));
    }).observe(canvas);
  }

  /** `wanted` is `webgl` or `webgpu`; otherwise what there is. */
  static async create(canvas: HTMLCanvasElement, wanted: string | null, onLost: () => void): Promise<Renderer> {
    const device = wanted === "webgl" ? null : await WebGPU.create(canvas, SHADER, onLost);
    return new Renderer(canvas, device ?? new WebGL(canvas));
  }

  get device(): Device["name"] {
    return this.drawing.name;
  }

  get hasSky(): boolean {
    return this.#isReady;
  }

  /** Exposure value of the picture. */
  exposure(view: View): number {
    return view.exposure ?? Math.log2(this.#automatic(view) / WHITE_AT_EV_0);
  }

  #automatic(view: View): number {
    const between = view.moonAzimuth - view.sunAzimuth;
    if (this.#eye !== null || between === this.#between) return this.#white;
    const lights = (["sun", "moon"] as const).flatMap((source) => {
      const lattice = this.#tables.get(source)?.lattice;
      return lattice ? [{ lattice, azimuth: view[`${source}Azimuth`] * RADIANS }] : [];
    });
    this.#white = whiteOfSky(lights);
    this.#between = between;
    return this.#white;
  }

  /** Whether how bright the picture is was looked at; from within the air that takes no picture. */
  isMetered(view: View): boolean {
    return this.#eye === null || view.exposure !== null || this.#metered === meterKey(view);
  }

  /** Looks how bright what is seen from space is. */
  async meter(view: View): Promise<void> {
    const key = meterKey(view);
    const height = Math.min(this.#height(view), METERED);
    const width = Math.round(height * aspect(view.projection));
    // A device without floating point keeps the exposure that there is.
    const light = await this.drawing.read(this.#values(view, -1, width, height), width, height).catch(() => null);
    if (light) this.#white = whiteOfPixels(light);
    this.#metered = key;
  }

  /** Sets one of the tables, or takes it away. */
  set(source: Source, tables: SkyTables | null): void {
    this.#between = NaN;
    this.#metered = "";
    if (tables) this.drawing.upload(skyTextures(source, tables));
    if (tables) this.#tables.set(source, tables);
    else this.#tables.delete(source);
  }

  /** All tables are there: what has none is black. */
  place(eye: Eye): void {
    if (eye !== this.#eye) this.#between = NaN;
    if (eye !== this.#eye) this.#metered = "";
    this.#eye = eye;
    this.#isReady = true;
  }

  /** What stands to the right of the divider. */
  beside(other: Coefficients | null): void {
    this.#other = other;
  }

  #height(view: View): number {
    return view.size ?? Math.max(1, Math.round(this.#cssHeight * Math.min(devicePixelRatio, 2)));
  }

  uploadLand(land: Land): void {
    this.drawing.upload(landTextures(land));
    this.#hasLand = true;
  }

  draw(view: View): void {
    const height = this.#height(view);
    const width = Math.round(height * aspect(view.projection));
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    this.drawing.draw(this.#values(view, TONES.indexOf(view.tone), width, height), width, height);
  }

  /** The light of the picture, in linear sRGB. */
  async light(view: View): Promise<Pixels> {
    const { width, height } = this.canvas;
    const light = await this.drawing.read(this.#values({ ...view, quantity: "radiance" }, -1, width, height), width, height);
    return { width, height, light };
  }

  #values(view: View, tone: number, width: number, height: number) {
    const white = WHITE_AT_EV_0 * 2 ** this.exposure(view);
    return values({ view, tables: this.#tables, eye: this.#eye, other: this.#other, hasLand: this.#hasLand, width, height, white, tone });
  }
}

function meterKey({ projection, viewAzimuth, pitch, field, sunAzimuth, size }: View): string {
  return [projection, viewAzimuth, pitch, field, sunAzimuth, size].join(" ");
}
