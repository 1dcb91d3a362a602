// What the page and its worker say to each other.

import type { Air, AirSize, Land } from "./terrain";

/** Intervals above the horizon, below it, and of the azimuth. */
export type Resolution = readonly [up: number, down: number, azimuths: number];

/** What a sky depends on; the azimuth of its light only turns it. */
export interface Scene {
  /** m */
  altitude: number;
  /** m */
  visibility: number;
  albedo: number;
  /** Of its light, rad. */
  elevation: number;
  /** Phase angle of the moon, degrees, where its light is the moon; null where it is the sun. */
  phase: number | null;
  /** From outside of the air: how far away, as an angle at the planet's centre (rad), rays enter it at most; null from
   * within. */
  reach: number | null;
  polarised: boolean;
  /** Whether the ground is seen; it is black if not. */
  grounded: boolean;
  /** Whether the sun's disc is seen. */
  disc: boolean;
  /** How finely the air before a landscape is tabulated; null without one. */
  air: AirSize | null;
  resolution: Resolution;
}

/** A sky in tables; the header's numbers are those of `describe` in `wasm/sky.c`, from outside those of `bake_space`. */
export interface SkyTables {
  header: Float32Array;
  /** Square roots of X, Y, Z and nothing, by row and column; from outside also by layer. */
  root: Float32Array;
  /** Q/I and U/(I sin azimuth) of X, Y, Z and nothing, by row and column; absent without polarisation. */
  degrees: Float32Array | null;
  /** Luminances of the upper hemisphere, cd m⁻², by ring and by spoke from the light's azimuth on; none from outside. */
  lattice: Float32Array;
  /** The header of the sun's disc and its coefficients, as `wasm/sun.h` has them; absent without it. */
  disc: Float32Array | null;
  air: Air | null;
  /** How long the worker took, ms: to prepare the sky, and to fill the tables. */
  prepared: number;
  baked: number;
}

export interface Limits {
  altitudes: number[];
  visibilities: number[];
  /** rad */
  elevations: [number, number];
  /** Of the planet, m. */
  radius: number;
}

export interface Traffic {
  requests: number;
  bytes: number;
  /** Length of all files that were asked. */
  total: number;
}

/** Rows of wavelength (nm), radiance, Q and U in the vertical frame (W m⁻² sr⁻¹ nm⁻¹). */
export type Spectrum = Float64Array;

/** A light, and where somebody looks from its azimuth on. */
export interface Look {
  scene: Scene;
  direction: [number, number, number];
}

export type Question =
  | { kind: "open"; id: number; colours: string; spectra: string; code: string }
  | { kind: "sky"; id: number; scene: Scene }
  | { kind: "land"; id: number; altitude: number; elevation: number; azimuth: number }
  | { kind: "look"; id: number; lights: Look[]; spectral: boolean }
  | { kind: "turbidity"; id: number; visibility: number };

export type Answer =
  | { kind: "opened"; id: number; limits: Limits }
  | { kind: "sky"; id: number; tables: SkyTables }
  | { kind: "land"; id: number; land: Land }
  | { kind: "look"; id: number; spectrum: Spectrum }
  | { kind: "turbidity"; id: number; turbidity: number }
  | { kind: "failed"; id: number; message: string }
  | { kind: "traffic"; traffic: Traffic };
