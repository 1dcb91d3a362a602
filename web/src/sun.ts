// The sun of an instant and a place, after Meeus, Astronomical Algorithms, chapters 12, 22 and 25: to about 0.01°.

const RADIANS = Math.PI / 180;
/** Julian date of 1970-01-01T00:00Z, and of the epoch J2000. */
const UNIX = 2440587.5;
const J2000 = 2451545;
/** Seconds by which the time of the orbits is ahead of universal time, about 2020. */
const DELTA_T = 70;

export interface Place {
  /** Degrees, north and east positive. */
  latitude: number;
  longitude: number;
}

const sine = (degrees: number) => Math.sin(degrees * RADIANS);
const cosine = (degrees: number) => Math.cos(degrees * RADIANS);
const turn = (degrees: number) => ((degrees % 360) + 360) % 360;

/** Apparent right ascension and declination, and the correction of sidereal time, degrees. */
function apparent(days: number): { ascension: number; declination: number; nutation: number } {
  const t = (days + DELTA_T / 86400) / 36525;
  const mean = 280.46646 + t * (36000.76983 + 0.0003032 * t);
  const anomaly = 357.52911 + t * (35999.05029 - 0.0001537 * t);
  const centre =
    (1.914602 - t * (0.004817 + 0.000014 * t)) * sine(anomaly) +
    (0.019993 - 0.000101 * t) * sine(2 * anomaly) +
    0.000289 * sine(3 * anomaly);
  const node = 125.04 - 1934.136 * t;
  const longitude = mean + centre - 0.00569 - 0.00478 * sine(node);
  const obliquity = 23.43929111 - t * (0.013004167 + t * (1.64e-7 - 5.036e-7 * t)) + 0.00256 * cosine(node);
  const ascension = Math.atan2(cosine(obliquity) * sine(longitude), cosine(longitude)) / RADIANS;
  const declination = Math.asin(sine(obliquity) * sine(longitude)) / RADIANS;
  return { ascension, declination, nutation: -0.00478 * sine(node) * cosine(obliquity) };
}

/** Elevation without refraction and azimuth counter-clockwise from the east, degrees; from above the ground at `place`,
 * as the sun's parallax there has it. */
export function sunAt(instant: Date, { latitude, longitude }: Place): { elevation: number; azimuth: number } {
  const days = instant.getTime() / 86_400_000 + UNIX - J2000;
  const { ascension, declination, nutation } = apparent(days);
  const sidereal = 280.46061837 + 360.98564736629 * days + nutation;
  const hour = sidereal + longitude - ascension;
  const height =
    Math.asin(sine(latitude) * sine(declination) + cosine(latitude) * cosine(declination) * cosine(hour)) / RADIANS;
  const west = cosine(declination) * sine(hour);
  const north = sine(declination) * cosine(latitude) - cosine(declination) * sine(latitude) * cosine(hour);
  const parallax = (8.794 / 3600) * cosine(height);
  return { elevation: height - parallax, azimuth: turn(Math.atan2(north, -west) / RADIANS) };
}
