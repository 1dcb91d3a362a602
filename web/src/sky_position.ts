// From places among the stars to those above a horizon.

export const RADIANS = Math.PI / 180;
/** Julian date of 1970-01-01T00:00Z, and of the epoch J2000. */
const UNIX = 2440587.5;
const J2000 = 2451545;

export interface Place {
  /** Degrees, north and east positive. */
  latitude: number;
  longitude: number;
}

/** Degrees. */
export interface Equatorial {
  ascension: number;
  declination: number;
}

/** Elevation without refraction and azimuth counter-clockwise from the east, degrees. */
export interface Horizontal {
  elevation: number;
  azimuth: number;
}

export const sine = (degrees: number) => Math.sin(degrees * RADIANS);
export const cosine = (degrees: number) => Math.cos(degrees * RADIANS);
export const turn = (degrees: number) => ((degrees % 360) + 360) % 360;

/** Of universal time since J2000. */
export function daysOf(instant: Date): number {
  return instant.getTime() / 86_400_000 + UNIX - J2000;
}

/** Julian centuries of the orbits' time since J2000, which is ahead of universal time: by the polynomial of Espenak and
 * Meeus for 2005 to 2050, from which the years about it differ by seconds. */
export function centuriesOf(days: number): number {
  const years = days / 365.25;
  const ahead = 62.92 + years * (0.32217 + 0.005589 * years);
  return (days + ahead / 86400) / 36525;
}

/** From the ecliptic, at an obliquity; degrees. */
export function equatorial(longitude: number, latitude: number, obliquity: number): Equatorial {
  const [s, c] = [sine(obliquity), cosine(obliquity)];
  const tangent = sine(latitude) / cosine(latitude);
  const ascension = Math.atan2(sine(longitude) * c - tangent * s, cosine(longitude)) / RADIANS;
  const declination = Math.asin(sine(latitude) * c + cosine(latitude) * s * sine(longitude)) / RADIANS;
  return { ascension, declination };
}

/** Above the ground at a place; `parallax` is that at the horizon, degrees, `nutation` that of sidereal time. */
export function horizontal(
  { ascension, declination }: Equatorial,
  days: number,
  { latitude, longitude }: Place,
  parallax: number,
  nutation: number,
): Horizontal {
  const hour = 280.46061837 + 360.98564736629 * days + nutation + longitude - ascension;
  const height =
    Math.asin(sine(latitude) * sine(declination) + cosine(latitude) * cosine(declination) * cosine(hour)) / RADIANS;
  const west = cosine(declination) * sine(hour);
  const north = sine(declination) * cosine(latitude) - cosine(declination) * sine(latitude) * cosine(hour);
  const lower = Math.atan2(sine(parallax) * cosine(height), 1 - sine(parallax) * sine(height)) / RADIANS;
  return { elevation: height - lower, azimuth: turn(Math.atan2(north, -west) / RADIANS) };
}
