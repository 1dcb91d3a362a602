// What the page and its worker say to each other.

import type { Air, AirSize, Land } from "./terrain";

/** Intervals above the horizon, below it, and of the azimuth. */
export type Resolution = readonly [up: number, down: number, azimuths: number];

/** What a sky depends on; the azimuth of the sun only turns it. */
export interface Scene {
  /** m */
  altitude: number;
  /** m */
  visibility: number;
  albedo: number;
  /** rad */
  elevation: number;
  polarised: boolean;
  /** Whether the ground is seen; it is black if not. */
  grounded: boolean;
  /** Whether the sun's disc is seen. */
  disc: boolean;
  /** How finely the air before a landscape is tabulated; null without one. */
  air: AirSize | null;
  resolution: Resolution;
}

/** A sky in tables; the header's numbers are those of `describe` in `wasm/sky.c`. */
export interface SkyTables {
  header: Float32Array;
  /** Square roots of X, Y, Z and nothing, by row and column. */
  root: Float32Array;
  /** Q/I and U/(I sin azimuth) of X, Y, Z and nothing, by row and column; absent without polarisation. */
  degrees: Float32Array | null;
  /** The header of the sun's disc and its coefficients, as `wasm/sun.h` has them; absent without it. */
  disc: Float32Array | null;
  air: Air | null;
  /** Geometric mean of the luminance of the upper hemisphere, cd m⁻². */
  mean: number;
  /** How long the worker took, ms: to prepare the sky, and to fill the tables. */
  prepared: number;
  baked: number;
}

export interface Limits {
  altitudes: number[];
  visibilities: number[];
  /** rad */
  elevations: [number, number];
}

export interface Traffic {
  requests: number;
  bytes: number;
  /** Length of all files that were asked. */
  total: number;
}

/** Rows of wavelength (nm), radiance (W m⁻² sr⁻¹ nm⁻¹), Q/L and U/L in the vertical frame. */
export type Spectrum = Float64Array;

export type Question =
  | { kind: "open"; id: number; colours: string; spectra: string; code: string }
  | { kind: "sky"; id: number; scene: Scene }
  | { kind: "land"; id: number; altitude: number; elevation: number; azimuth: number }
  | { kind: "look"; id: number; scene: Scene; direction: [number, number, number]; spectral: boolean };

export type Answer =
  | { kind: "opened"; id: number; limits: Limits }
  | { kind: "sky"; id: number; tables: SkyTables }
  | { kind: "land"; id: number; land: Land }
  | { kind: "look"; id: number; spectrum: Spectrum }
  | { kind: "failed"; id: number; message: string }
  | { kind: "traffic"; traffic: Traffic };
