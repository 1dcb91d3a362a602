// What the library says of the segments between a camera and the viewer's ridges.

import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";

const WELKIN = process.env.WELKIN ?? "welkin";
const DIST = new URL("../dist/", import.meta.url).pathname;
const MODEL = `${DIST}sky.welkin`;

/** What a head says about colours: the format specification, section 4. */
export function readHead(bytes = readFileSync(MODEL)) {
  const [wavelengths, altitudes, visibilities, fields, constituents] = [40, 42, 44, 46, 48].map((at) => bytes.readUInt16LE(at));
  const samples = bytes.readUInt16LE(58);
  const xyz = 128 + 8 * (wavelengths * (2 + visibilities * (constituents + 1) + fields - 1) + altitudes + visibilities);
  const range = xyz + 24 * wavelengths;
  const [first, step] = [bytes.readDoubleLE(range), bytes.readDoubleLE(range + 8)];
  return Array.from({ length: wavelengths }, (_, i) => {
    const wavelength = bytes.readDoubleLE(128 + 8 * i);
    const u = (wavelength - first) / step;
    const k = Math.min(Math.floor(u), samples - 2);
    const solar = (index) => bytes.readFloatLE(range + 16 + 4 * index);
    return {
      wavelength,
      irradiance: solar(k) + (u - k) * (solar(k + 1) - solar(k)),
      xyz: [0, 1, 2].map((c) => bytes.readDoubleLE(xyz + 24 * i + 8 * c)),
    };
  });
}

/** Y of the light that the air of segments scatters, as the library's command has it at the wavelengths of the viewer's
 * model. Segments have a direction, and a distance in m. */
export function luminances(segments, { altitude, visibility, sunElevation, sunAzimuth = 0, albedo = 0.2 }) {
  const nodes = readHead();
  const header = "quantity,visibility_km,albedo,altitude_m,solar_elevation_deg,view_zenith_deg,view_azimuth_deg,wavelength_nm,distance_m";
  const degrees = (angle) => (angle * 180) / Math.PI;
  const rows = segments.flatMap(({ direction: [x, y, z], distance }) => {
    const [zenith, azimuth] = [degrees(Math.acos(z)), degrees(Math.atan2(y, x)) - sunAzimuth];
    return nodes.map((node) => ["in_scattering", visibility, albedo, altitude, sunElevation, zenith, azimuth, node.wavelength, distance]);
  });
  const input = [header, ...rows].join("\n");
  const output = execFileSync(WELKIN, ["query", "--model", MODEL, "--strict"], { input, encoding: "utf8", maxBuffer: 1 << 26 });
  const [names, ...answers] = output.trim().split(/\r?\n/).map((line) => line.split(","));
  const value = names.findIndex((name) => !header.split(",").includes(name));
  return segments.map((_, i) =>
    nodes.reduce((sum, node, k) => sum + (Number(answers[i * nodes.length + k][value]) / node.irradiance) * node.xyz[1], 0),
  );
}

/** Heights of the viewer's landscape, of its own code. */
export async function heights() {
  const { instance } = await WebAssembly.instantiate(readFileSync(`${DIST}welkin.wasm`), {});
  return instance.exports.terrain_height;
}

const RADIUS = 6_378_000;

/** How far a line of sight is free, m; infinite in the sky. Steps are finer than anything in the landscape. */
export function freeDistance(height, camera, [x, y, z]) {
  const clearance = (s) => {
    const [px, py, pz] = [s * x, s * y, camera + s * z];
    const way = pz + (px * px + py * py + pz * pz) / (2 * RADIUS);
    return (2 * way) / (1 + Math.sqrt(1 + (2 * way) / RADIUS)) - height(px, py);
  };
  let s = 0;
  for (let step = 5; s < 2e5; step = Math.max(5, 0.001 * s)) {
    if (clearance(s + step) < 0) {
      let [near, far] = [s, s + step];
      for (let i = 0; i < 30; i++) {
        const middle = (near + far) / 2;
        if (clearance(middle) < 0) far = middle;
        else near = middle;
      }
      return near;
    }
    s += step;
  }
  return Infinity;
}

/** Direction of a pixel of a picture in perspective, 1.5 times as wide as high. */
export function pixelDirection([column, row], height, { viewAzimuth = 0, pitch, field }) {
  const radians = Math.PI / 180;
  const half = Math.tan((field * radians) / 2);
  const [right, above] = [(2 * (column + 0.5)) / (1.5 * height) - 1, 1 - (2 * (row + 0.5)) / height].map((v, i) => v * half * (i ? 1 : 1.5));
  const [sp, cp] = [Math.sin(pitch * radians), Math.cos(pitch * radians)];
  const [sa, ca] = [Math.sin(viewAzimuth * radians), Math.cos(viewAzimuth * radians)];
  const parts = [cp * ca + right * sa - above * sp * ca, cp * sa - right * ca - above * sp * sa, sp + above * cp];
  const length = Math.hypot(...parts);
  return parts.map((v) => v / length);
}
