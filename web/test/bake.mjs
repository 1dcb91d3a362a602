// CPU milliseconds of what the worker does for a new sky: `node test/bake.mjs`.

import { readFileSync } from "node:fs";

const dist = new URL("../dist/", import.meta.url);
const { instance } = await WebAssembly.instantiate(readFileSync(new URL("welkin.wasm", dist)), {});
const wasm = instance.exports;
const bytes = readFileSync(new URL("sky.welkin", dist));
const start = wasm.reserve(0, bytes.length);
new Uint8Array(wasm.memory.buffer).set(bytes, start);
if (wasm.open_file(0) !== 0) throw new Error("the model does not open");

function measure(count, once) {
  const checked = (i) => {
    const error = once(i);
    if (error !== 0) throw new Error(`error ${error}`);
  };
  for (let i = 0; i < count / 4; i++) checked(i);
  const before = process.cpuUsage();
  for (let i = 0; i < count; i++) checked(i);
  const { user, system } = process.cpuUsage(before);
  return ((user + system) / 1e3 / count).toFixed(1);
}

function sky([up, down, azimuths], polarised, grounded, altitude) {
  return measure(20, (i) => {
    const error = wasm.prepare(0, altitude, 59400, 0.2, 0.3 + 0.01 * i, -1, polarised);
    return error || wasm.bake(0, up, down, azimuths, polarised, grounded);
  });
}

/** From outside: the page's tables, as `reader.ts` lays them out. */
function space([up, down, azimuths], altitude) {
  const radius = wasm.radius(0);
  const top = wasm.node_of(0, 1, wasm.count_of(0, 1) - 1);
  const reach = Math.acos((radius + top) / (radius + altitude));
  const [sun, step] = [0.3, (0.15 * 48) / up];
  return measure(4, (i) => {
    const around = [sun + 0.01 * i - reach, sun + 0.01 * i + reach];
    return wasm.bake_space(0, 59400, 0.2, ...around, step, (2 * up) / 3, down, (3 * azimuths) / 4, 1);
  });
}

console.log("table,polarised,ground,altitude_m,cpu_ms");
for (const resolution of [[24, 8, 16], [48, 24, 32]]) {
  const name = `${resolution[0]}+${resolution[1]}x${resolution[2]}`;
  for (const [polarised, grounded, altitude] of [[0, 0, 0], [0, 1, 0], [1, 1, 0], [0, 1, 10000]]) {
    console.log([name, polarised, grounded, altitude, sky(resolution, polarised, grounded, altitude)].join(","));
  }
  for (const altitude of [400e3, 20000e3]) console.log([name, 0, 1, altitude, space(resolution, altitude)].join(","));
}
