// Which tables a view needs.

import { otherKey } from "./beside";
import { sunDirection } from "./disc";
import type { Look, Limits, Resolution, Scene } from "./protocol";
import type { Vector } from "./directions";
import type { Eye, Source } from "./inputs";
import { entry, reach } from "./space";
import { COARSE_AIR, EYE, FINE_AIR } from "./terrain";
import type { View } from "./view";

const RADIANS = Math.PI / 180;
/** While something moves, and when it rests. */
export const COARSE: Resolution = [24, 8, 16];
export const FINE: Resolution = [48, 24, 32];
export const SOURCES: readonly Source[] = ["sun", "moon", "space"];

export interface Wanted extends Record<Source, Scene | null> {
  eye: Eye;
  other: string;
  /** What the landscape's shadows depend on; null without one. */
  land: { altitude: number; elevation: number; azimuth: number } | null;
}

const ceiling = ({ altitudes }: Limits) => altitudes.at(-1)!;

/** Distance from the planet's centre, of that of the highest altitude of the model; null within the model. */
function eyeOf({ altitude }: View, limits: Limits): Eye {
  return altitude > ceiling(limits) ? (limits.radius + altitude) / (limits.radius + ceiling(limits)) : null;
}

export function wanted(view: View, limits: Limits, resolution: Resolution): Wanted {
  const eye = eyeOf(view, limits);
  const other = otherKey(view);
  if (eye !== null) return { sun: null, moon: null, space: spaceScene(view, limits, resolution, eye), eye, other, land: null };
  const light = (elevation: number, phase: number | null) => scene(view, limits, resolution, elevation, phase);
  const moon = view.moonElevation === null ? null : light(view.moonElevation, view.moonPhase);
  const sun = light(view.sunElevation, null);
  const { altitude, elevation } = sun ?? { altitude: 0, elevation: 0 };
  const land = sun?.air ? { altitude, elevation, azimuth: view.sunAzimuth * RADIANS } : null;
  return { sun, moon, space: null, eye, other, land };
}

/** The degree of polarisation is that of the sky alone. */
function hasLandscape({ terrain, quantity }: View): boolean {
  return terrain === "ridges" && quantity !== "dolp";
}

/** Null for a light that is deeper than the model has any. */
function scene(view: View, limits: Limits, resolution: Resolution, degrees: number, phase: number | null): Scene | null {
  const { visibility, altitude, albedo, ground, disc, quantity, polariser } = view;
  const [lowest, highest] = limits.elevations;
  const elevation = Math.min(degrees * RADIANS, highest);
  if (elevation < lowest) return null;
  return {
    altitude: hasLandscape(view) ? Math.max(altitude, EYE) : altitude,
    visibility: 1e3 * visibility,
    albedo,
    elevation,
    phase,
    reach: null,
    polarised: quantity === "dolp" || polariser !== null,
    // The degree of polarisation is that of the sky's light alone.
    grounded: ground === "lit" && quantity !== "dolp",
    disc: phase === null && disc === "shown" && quantity !== "dolp",
    air: phase === null && hasLandscape(view) ? (resolution === FINE ? FINE_AIR : COARSE_AIR) : null,
    resolution,
  };
}

/** In colour only; null where all that is seen is night. */
function spaceScene(view: View, limits: Limits, resolution: Resolution, eye: number): Scene | null {
  const [elevation, far] = [view.sunElevation * RADIANS, reach(1, eye)];
  if (elevation + far < limits.elevations[0]) return null;
  return {
    altitude: ceiling(limits),
    visibility: 1e3 * view.visibility,
    albedo: view.albedo,
    elevation,
    phase: null,
    reach: far,
    polarised: false,
    grounded: view.ground === "lit",
    disc: false,
    air: null,
    resolution,
  };
}

/** The lights in a direction. */
export function looks(view: View, limits: Limits, resolution: Resolution, direction: Vector): Look[] {
  const { sun, moon, space, eye } = wanted(view, limits, resolution);
  if (eye === null) {
    const turned = [[sun, view.sunAzimuth], [moon, view.moonAzimuth]] as const;
    return turned.flatMap(([scene, azimuth]) => (scene ? [{ scene, direction: turn(direction, azimuth) }] : []));
  }
  const there = space && entry(eye, direction, sunDirection(view));
  if (!there || there.elevation < limits.elevations[0]) return [];
  return [{ scene: { ...space, elevation: there.elevation }, direction: there.direction }];
}

function turn([x, y, z]: Vector, azimuth: number): Vector {
  const [c, s] = [Math.cos(azimuth * RADIANS), Math.sin(azimuth * RADIANS)];
  return [x * c + y * s, y * c - x * s, z];
}

export function isSame(a: Wanted, b: Wanted | null): boolean {
  return b !== null && a.eye === b.eye && a.other === b.other && isSameLand(a.land, b.land) && SOURCES.every((name) => isSameScene(a[name], b[name]));
}

function isSameLand(a: Wanted["land"], b: Wanted["land"]): boolean {
  if (a === null || b === null) return a === b;
  return a.altitude === b.altitude && a.elevation === b.elevation && a.azimuth === b.azimuth;
}

export function isSameScene(a: Scene | null, b: Scene | null): boolean {
  if (a === null || b === null) return a === b;
  for (const key in a) if (a[key as keyof Scene] !== b[key as keyof Scene]) return false;
  return true;
}
