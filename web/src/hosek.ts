// The sky of L. Hosek and A. Wilkie, An Analytic Model for Full Spectral Sky-Dome Radiance, ACM Transactions on Graphics
// 31 (2012), in red, green and blue: its formulae, over the authors' data (`hosek.bin`, whose licence stands beside it).

import { Failure, message } from "./failure";

/** Of a quintic Bézier curve over the cube root of the sun's elevation. */
const POINTS = 6;
const PARAMETERS = 9;
const TURBIDITIES = 10;
const ALBEDOS = 2;
const CHANNELS = 3;
/** Red, green, blue and nothing. */
const STRIDE = 4;
/** Of one channel: parameters, and after those of all channels radiances. */
const SHAPE = PARAMETERS * POINTS * TURBIDITIES * ALBEDOS;
const LEVEL = POINTS * TURBIDITIES * ALBEDOS;
/** lm W⁻¹: the data are radiances. */
const EFFICACY = 683;
const BINOMIALS = [1, 5, 10, 10, 5, 1];

/** Red, green, blue and nothing of each parameter, and last those of the radiance (cd m⁻²): what the shader takes. */
export type Coefficients = Float32Array;

export class Hosek {
  constructor(private readonly data: Float32Array) {
    if (data.length !== CHANNELS * (SHAPE + LEVEL)) throw new Failure("The data of Hosek and Wilkie are not whole.");
  }

  static async load(url: string): Promise<Hosek> {
    try {
      const response = await fetch(url);
      if (!response.ok) throw new Error(`the server says ${response.status}`);
      return new Hosek(new Float32Array(await response.arrayBuffer()));
    } catch (error) {
      if (error instanceof Failure) throw error;
      throw new Failure(`The data of Hosek and Wilkie cannot be fetched: ${message(error)}.`);
    }
  }

  /** For a sun at or above the horizon (rad); the turbidity is kept within the model's 1 to 10. */
  coefficients(elevation: number, turbidity: number, albedo: number): Coefficients {
    const out = new Float32Array((PARAMETERS + 1) * STRIDE);
    for (let c = 0; c < CHANNELS; c++) {
      const at = (start: number, stride: number, i: number) => {
        return between(turbidity, albedo, (t, a) => this.#curve(start + i, stride, a * TURBIDITIES + t, elevation));
      };
      for (let i = 0; i < PARAMETERS; i++) out[STRIDE * i + c] = at(c * SHAPE, PARAMETERS, i);
      out[STRIDE * PARAMETERS + c] = EFFICACY * at(CHANNELS * SHAPE + c * LEVEL, 1, 0);
    }
    return out;
  }

  #curve(start: number, stride: number, index: number, elevation: number): number {
    const t = Math.cbrt(elevation / (Math.PI / 2));
    let sum = 0;
    for (let p = 0; p < POINTS; p++) {
      const weight = BINOMIALS[p]! * t ** p * (1 - t) ** (POINTS - 1 - p);
      sum += weight * this.data[start + stride * (POINTS * index + p)]!;
    }
    return sum;
  }
}

/** Linear over turbidity and albedo. */
function between(turbidity: number, albedo: number, at: (turbidity: number, albedo: number) => number): number {
  const place = Math.min(Math.max(turbidity, 1), TURBIDITIES) - 1;
  const low = Math.min(Math.floor(place), TURBIDITIES - 2);
  const part = place - low;
  const over = (a: number) => (1 - part) * at(low, a) + part * at(low + 1, a);
  return (1 - albedo) * over(0) + albedo * over(1);
}

export const HOSEK_SHADER = `
uniform vec4 hosek[10];  // red, green and blue of parameters A to I, and the radiance, cd m^-2
uniform vec3 hosek_sun;
uniform float divider;   // share of the width that is the model's

// Linear sRGB; the model has no light below the horizon.
vec3 hosek_wilkie(vec3 v) {
  if (v.z < 0.0) return vec3(0.0);
  float cosine = clamp(dot(v, hosek_sun), -1.0, 1.0), gamma = acos(cosine), square = cosine * cosine;
  vec3 haze = (1.0 + square) / pow(1.0 + hosek[8].rgb * hosek[8].rgb - 2.0 * hosek[8].rgb * cosine, vec3(1.5));
  vec3 level = 1.0 + hosek[0].rgb * exp(hosek[1].rgb / (v.z + 0.01));
  vec3 around = hosek[2].rgb + hosek[3].rgb * exp(hosek[4].rgb * gamma) + hosek[5].rgb * square + hosek[6].rgb * haze + hosek[7].rgb * sqrt(v.z);
  return hosek[9].rgb * level * around;
}
`;
