// Which tables a view needs.

import { otherKey } from "./beside";
import type { Look, Limits, Resolution, Scene } from "./protocol";
import { type Vector, sunVector } from "./directions";
import type { Eye, Source } from "./renderer";
import { entry, reach } from "./space";
import type { View } from "./view";

const RADIANS = Math.PI / 180;
export const SOURCES: readonly Source[] = ["sun", "moon", "space"];

export interface Wanted extends Record<Source, Scene | null> {
  eye: Eye;
  other: string;
}

const ceiling = ({ altitudes }: Limits) => altitudes.at(-1)!;

/** Distance from the planet's centre, of that of the highest altitude of the model; null within the model. */
function eyeOf({ altitude }: View, limits: Limits): Eye {
  return altitude > ceiling(limits) ? (limits.radius + altitude) / (limits.radius + ceiling(limits)) : null;
}

export function wanted(view: View, limits: Limits, resolution: Resolution): Wanted {
  const eye = eyeOf(view, limits);
  const other = otherKey(view);
  if (eye !== null) return { sun: null, moon: null, space: spaceScene(view, limits, resolution, eye), eye, other };
  const light = (elevation: number, phase: number | null) => scene(view, limits, resolution, elevation, phase);
  const moon = view.moonElevation === null ? null : light(view.moonElevation, view.moonPhase);
  return { sun: light(view.sunElevation, null), moon, space: null, eye, other };
}

/** Null for a light that is deeper than the model has any. */
function scene(view: View, limits: Limits, resolution: Resolution, degrees: number, phase: number | null): Scene | null {
  const { visibility, altitude, albedo, ground, quantity, polariser } = view;
  const [lowest, highest] = limits.elevations;
  const elevation = Math.min(degrees * RADIANS, highest);
  if (elevation < lowest) return null;
  return {
    altitude,
    visibility: 1e3 * visibility,
    albedo,
    elevation,
    phase,
    reach: null,
    polarised: quantity === "dolp" || polariser !== null,
    // The degree of polarisation is that of the sky's light alone.
    grounded: ground === "lit" && quantity !== "dolp",
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
  const there = space && entry(eye, direction, sunVector(view));
  if (!there || there.elevation < limits.elevations[0]) return [];
  return [{ scene: { ...space, elevation: there.elevation }, direction: there.direction }];
}

function turn([x, y, z]: Vector, azimuth: number): Vector {
  const [c, s] = [Math.cos(azimuth * RADIANS), Math.sin(azimuth * RADIANS)];
  return [x * c + y * s, y * c - x * s, z];
}

export function isSame(a: Wanted, b: Wanted | null): boolean {
  return b !== null && a.eye === b.eye && a.other === b.other && SOURCES.every((name) => isSameScene(a[name], b[name]));
}

export function isSameScene(a: Scene | null, b: Scene | null): boolean {
  if (a === null || b === null) return a === b;
  for (const key in a) if (a[key as keyof Scene] !== b[key as keyof Scene]) return false;
  return true;
}
