// How bright a picture is, as `welkin render` exposes it.

/** Luminance of scene white at exposure value 0 (ISO 100), cd m⁻². */
export const WHITE_AT_EV_0 = 1.2;
/** What the mean of a sky is of white, and that of what is seen from space. */
const SKY = 0.36;
const LANDSCAPE = 0.25;
/** This share of a landscape may be brighter than so many times white. */
const BRIGHTEST = 0.05;
const BRIGHT = 2;
const LEAST = 1e-12;
/** Spokes of a ring of luminances. */
const SPOKES = 32;

/** White, cd m⁻², for the sum of lights: luminances by ring and spoke, from each light's azimuth (rad) on. The first
 * light's spokes count. */
export function whiteOfSky(lights: { lattice: Float32Array; azimuth: number }[]): number {
  const [first, ...rest] = lights;
  if (!first) return WHITE_AT_EV_0;
  let sum = 0;
  first.lattice.forEach((own, i) => {
    let luminance = own;
    for (const { lattice, azimuth } of rest) {
      luminance += onRing(lattice, i - (i % SPOKES), (i % SPOKES) + ((first.azimuth - azimuth) / (2 * Math.PI)) * SPOKES);
    }
    sum += Math.log(Math.max(luminance, LEAST));
  });
  return Math.exp(sum / first.lattice.length) / SKY;
}

/** Between the spokes. */
function onRing(lattice: Float32Array, ring: number, spoke: number): number {
  const low = Math.floor(spoke);
  const at = (k: number) => lattice[ring + (((k % SPOKES) + SPOKES) % SPOKES)]!;
  return at(low) + (spoke - low) * (at(low + 1) - at(low));
}

/** White for pixels of linear sRGB and 1; those that are black are space. */
export function whiteOfPixels(light: Float32Array): number {
  const lit: number[] = [];
  for (let i = 0; i < light.length; i += 4) {
    const luminance = 0.2126 * light[i]! + 0.7152 * light[i + 1]! + 0.0722 * light[i + 2]!;
    if (luminance > 0) lit.push(luminance);
  }
  if (lit.length === 0) return WHITE_AT_EV_0;
  const mean = Math.exp(lit.reduce((sum, l) => sum + Math.log(Math.max(l, LEAST)), 0) / lit.length);
  const sorted = Float64Array.from(lit).sort();
  return Math.max(mean / LANDSCAPE, sorted[Math.floor(lit.length * (1 - BRIGHTEST))]! / BRIGHT);
}
