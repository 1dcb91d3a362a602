// From places in the picture to directions: `welkin render`'s projections. The shader does the same.

import type { View } from "./view";

export type Vector = [x: number, y: number, z: number];

const RADIANS = Math.PI / 180;

/** Width over height of the picture. */
export function aspect(projection: View["projection"]): number {
  return projection === "lat-long" ? 2 : projection === "perspective" ? 1.5 : 1;
}

/** The right, upward and forward axes of a camera. */
export function cameraAxes(view: View): [Vector, Vector, Vector] {
  const [sa, ca] = [Math.sin(view.viewAzimuth * RADIANS), Math.cos(view.viewAzimuth * RADIANS)];
  if (view.projection === "up") return [[-sa, ca, 0], [ca, sa, 0], [0, 0, 1]];
  const pitch = view.projection === "perspective" ? view.pitch * RADIANS : 0;
  const [sp, cp] = [Math.sin(pitch), Math.cos(pitch)];
  return [[sa, -ca, 0], [-sp * ca, -sp * sa, cp], [cp * ca, cp * sa, sp]];
}

/** Components along the camera's axes at a place, both −1 to 1 to the right and upwards; null outside a fish-eye. */
function local(view: View, right: number, above: number): Vector | null {
  if (view.projection === "lat-long") {
    const [azimuth, elevation] = [right * Math.PI, (above * Math.PI) / 2];
    const level = Math.cos(elevation);
    return [level * Math.sin(azimuth), Math.sin(elevation), level * Math.cos(azimuth)];
  }
  if (view.projection === "perspective") {
    const half = Math.tan((view.field * RADIANS) / 2);
    const [x, y] = [right * half * aspect("perspective"), above * half];
    const length = Math.hypot(x, y, 1);
    return [x / length, y / length, 1 / length];
  }
  const radius = Math.hypot(right, above);
  if (radius >= 1) return null;
  const angle = (radius * Math.PI) / 2;
  const scale = radius > 0 ? Math.sin(angle) / radius : 0;
  return [right * scale, above * scale, Math.cos(angle)];
}

/** Unit vector in the world, +z up, azimuths counter-clockwise from +x. */
export function direction(view: View, right: number, above: number): Vector | null {
  const parts = local(view, right, above);
  if (!parts) return null;
  const axes = cameraAxes(view);
  const sum = (k: 0 | 1 | 2) => parts[0] * axes[0][k] + parts[1] * axes[1][k] + parts[2] * axes[2][k];
  return [sum(0), sum(1), sum(2)];
}

/** Where a picture with these axes of its camera shows a direction; null where it does not. */
export function place(view: View, axes: [Vector, Vector, Vector], towards: Vector): [number, number] | null {
  const along = (axis: Vector) => axis[0] * towards[0] + axis[1] * towards[1] + axis[2] * towards[2];
  const [right, above, ahead] = [along(axes[0]), along(axes[1]), along(axes[2])];
  if (view.projection === "lat-long") {
    return [Math.atan2(right, ahead) / Math.PI, Math.atan2(above, Math.hypot(right, ahead)) / (Math.PI / 2)];
  }
  if (view.projection === "perspective") {
    const half = Math.tan((view.field * RADIANS) / 2);
    return ahead > 1e-3 ? [right / (ahead * half * aspect("perspective")), above / (ahead * half)] : null;
  }
  const across = Math.hypot(right, above);
  const scale = across > 0 ? Math.atan2(across, ahead) / (Math.PI / 2) / across : 0;
  return [right * scale, above * scale];
}
