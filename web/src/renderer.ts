// Draws the sky: with WebGPU where there is such a device, else with WebGL2.

import { aspect } from "./directions";
import type { Device } from "./gpu/device";
import { WebGL } from "./gpu/webgl";
import { WebGPU } from "./gpu/webgpu";
import { landTextures, skyTextures, values } from "./inputs";
import type { SkyTables } from "./protocol";
import type { Land } from "./terrain";
import { TONES, type View } from "./view";

/** Luminance of scene white at exposure value 0 (ISO 100), cd m⁻², and what a sky's mean is of white. */
const WHITE_AT_EV_0 = 1.2;
const SKY = 0.36;
const SHADER = "sky.wgsl";

export interface Pixels {
  width: number;
  height: number;
  /** R, G, B and 1, cd m⁻², from the bottom up. */
  light: Float32Array;
}

export class Renderer {
  #tables: SkyTables | null = null;
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
    return this.#tables !== null;
  }

  /** Exposure value of the picture. */
  exposure(view: View): number {
    return view.exposure ?? Math.log2((this.#tables?.mean ?? 1) / SKY / WHITE_AT_EV_0);
  }

  upload(tables: SkyTables): void {
    this.drawing.upload(skyTextures(tables));
    this.#tables = tables;
  }

  uploadLand(land: Land): void {
    this.drawing.upload(landTextures(land));
    this.#hasLand = true;
  }

  draw(view: View): void {
    const height = view.size ?? Math.max(1, Math.round(this.#cssHeight * Math.min(devicePixelRatio, 2)));
    const width = Math.round(height * aspect(view.projection));
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    this.drawing.draw(this.#values(view, TONES.indexOf(view.tone)), width, height);
  }

  /** The light of the picture, in linear sRGB. */
  async light(view: View): Promise<Pixels> {
    const { width, height } = this.canvas;
    const light = await this.drawing.read(this.#values({ ...view, quantity: "radiance" }, -1), width, height);
    return { width, height, light };
  }

  #values(view: View, tone: number) {
    const { width, height } = this.canvas;
    const white = WHITE_AT_EV_0 * 2 ** this.exposure(view);
    return values({ view, tables: this.#tables!, hasLand: this.#hasLand, width, height, white, tone });
  }
}
