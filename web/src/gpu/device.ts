// What draws: WebGL2 or WebGPU.

import type { Textures, Values } from "../inputs";

export interface Device {
  readonly name: "webgl" | "webgpu";
  /** Takes textures in place of those of the same names. */
  upload(textures: Textures): void;
  /** Onto the canvas. */
  draw(values: Values, width: number, height: number): void;
  /** Red, green, blue and 1 in floats, from the bottom up. */
  read(values: Values, width: number, height: number): Promise<Float32Array>;
}
