// The moon of an instant and a place, after Meeus, Astronomical Algorithms, chapter 47 with its largest terms: to some
// hundredths of a degree.

import { centuriesOf, cosine, daysOf, equatorial, type Horizontal, horizontal, type Place, RADIANS, sine } from "./sky_position";
import { sunLongitude, tilt } from "./sun";

/** Multiples of the elongation, the anomalies of sun and moon, and the moon's distance from its node; then 10⁻⁶ degrees
 * of longitude and metres of distance. */
const LONGITUDE: readonly (readonly [number, number, number, number, number, number])[] = [
  [0, 0, 1, 0, 6288774, -20905355], [2, 0, -1, 0, 1274027, -3699111], [2, 0, 0, 0, 658314, -2955968],
  [0, 0, 2, 0, 213618, -569925], [0, 1, 0, 0, -185116, 48888], [0, 0, 0, 2, -114332, -3149],
  [2, 0, -2, 0, 58793, 246158], [2, -1, -1, 0, 57066, -152138], [2, 0, 1, 0, 53322, -170733],
  [2, -1, 0, 0, 45758, -204586], [0, 1, -1, 0, -40923, -129620], [1, 0, 0, 0, -34720, 108743],
  [0, 1, 1, 0, -30383, 104755], [2, 0, 0, -2, 15327, 10321], [0, 0, 1, 2, -12528, 0],
  [0, 0, 1, -2, 10980, 79661], [4, 0, -1, 0, 10675, -34782], [0, 0, 3, 0, 10034, -23210],
  [4, 0, -2, 0, 8548, -21636], [2, 1, -1, 0, -7888, 24208], [2, 1, 0, 0, -6766, 30824],
  [1, 0, -1, 0, -5163, -8379], [1, 1, 0, 0, 4987, -16675], [2, -1, 1, 0, 4036, -12831],
  [2, 0, 2, 0, 3994, -10445], [4, 0, 0, 0, 3861, -11650], [2, 0, -3, 0, 3665, 14403],
];
/** The same with 10⁻⁶ degrees of latitude. */
const LATITUDE: readonly (readonly [number, number, number, number, number])[] = [
  [0, 0, 0, 1, 5128122], [0, 0, 1, 1, 280602], [0, 0, 1, -1, 277693], [2, 0, 0, -1, 173237], [2, 0, -1, 1, 55413],
  [2, 0, -1, -1, 46271], [2, 0, 0, 1, 32573], [0, 0, 2, 1, 17198], [2, 0, 1, -1, 9266], [0, 0, 2, -1, 8822],
  [2, -1, 0, -1, 8216], [2, 0, -2, -1, 4324], [2, 0, 1, 1, 4200], [2, 1, 0, -1, -3359], [2, -1, -1, 1, 2463],
  [2, -1, 0, 1, 2211], [2, -1, -1, -1, 2065],
];
/** km: of the planet's equator, and how many times as far away the sun is. */
const EQUATOR = 6378.14;
const SUN = 389.17;

/** Geocentric, of the date's equinox, without nutation: degrees and km. */
export function ecliptic(t: number): { longitude: number; latitude: number; distance: number } {
  const mean = 218.3164477 + 481267.88123421 * t;
  const elongation = 297.8501921 + 445267.1114034 * t;
  const sun = 357.5291092 + 35999.0502909 * t;
  const moon = 134.9633964 + 477198.8675055 * t;
  const node = 93.272095 + 483202.0175233 * t;
  const eccentricity = 1 - 0.002516 * t;
  const angle = ([d, m, own, f]: readonly number[]) => d! * elongation + m! * sun + own! * moon + f! * node;
  const size = ([, m]: readonly number[]) => eccentricity ** Math.abs(m!);
  let [longitude, latitude, distance] = [mean, 0, 385000.56];
  for (const term of LONGITUDE) {
    longitude += 1e-6 * term[4] * size(term) * sine(angle(term));
    distance += 1e-3 * term[5] * size(term) * cosine(angle(term));
  }
  for (const term of LATITUDE) latitude += 1e-6 * term[4] * size(term) * sine(angle(term));
  // Venus, and the flattening of the Earth.
  longitude += 1e-6 * (3958 * sine(119.75 + 131.849 * t) + 1962 * sine(mean - node));
  latitude += 1e-6 * (-2235 * sine(mean) + 382 * sine(313.45 + 481266.484 * t));
  return { longitude, latitude, distance };
}

/** With its phase angle, degrees. */
export function moonAt(instant: Date, place: Place): Horizontal & { phase: number } {
  const days = daysOf(instant);
  const t = centuriesOf(days);
  const { obliquity, node } = tilt(t);
  const { longitude, latitude, distance } = ecliptic(t);
  const inLongitude = -0.00478 * sine(node);
  const there = equatorial(longitude + inLongitude, latitude, obliquity);
  const parallax = Math.asin(EQUATOR / distance) / RADIANS;
  const elongation = Math.acos(cosine(latitude) * cosine(longitude + inLongitude - sunLongitude(t)));
  const phase = Math.atan2(SUN * Math.sin(elongation), 1 - SUN * Math.cos(elongation)) / RADIANS;
  return { ...horizontal(there, days, place, parallax, inLongitude * cosine(obliquity)), phase };
}
