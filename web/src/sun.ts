// The sun of an instant and a place, after Meeus, Astronomical Algorithms, chapters 12, 22 and 25: to about 0.01°.

import { centuriesOf, cosine, daysOf, equatorial, type Horizontal, horizontal, type Place, sine } from "./sky_position";

/** Of the equator to the ecliptic at Julian centuries since J2000, and the moon's node that it nods with; degrees. */
export function tilt(t: number): { obliquity: number; node: number } {
  const node = 125.04 - 1934.136 * t;
  return { obliquity: 23.43929111 - t * (0.013004167 + t * (1.64e-7 - 5.036e-7 * t)) + 0.00256 * cosine(node), node };
}

/** Apparent longitude, degrees. */
export function sunLongitude(t: number): number {
  const mean = 280.46646 + t * (36000.76983 + 0.0003032 * t);
  const anomaly = 357.52911 + t * (35999.05029 - 0.0001537 * t);
  const centre =
    (1.914602 - t * (0.004817 + 0.000014 * t)) * sine(anomaly) +
    (0.019993 - 0.000101 * t) * sine(2 * anomaly) +
    0.000289 * sine(3 * anomaly);
  return mean + centre - 0.00569 - 0.00478 * sine(tilt(t).node);
}

export function sunAt(instant: Date, place: Place): Horizontal {
  const days = daysOf(instant);
  const t = centuriesOf(days);
  const { obliquity, node } = tilt(t);
  const nutation = -0.00478 * sine(node) * cosine(obliquity);
  return horizontal(equatorial(sunLongitude(t), 0, obliquity), days, place, 8.794 / 3600, nutation);
}
