// CPU milliseconds of what the worker does for a new sky: `node test/bake.mjs`.

import { readFileSync } from "node:fs";

const dist = new URL("../dist/", import.meta.url);
const { instance } = await WebAssembly.instantiate(readFileSync(new URL("welkin.wasm", dist)), {});
const wasm = instance.exports;
const bytes = readFileSync(new URL("sky.welkin", dist));
const start = wasm.reserve(0, bytes.length);
new Uint8Array(wasm.memory.buffer).set(bytes, start);
if (wasm.open_file(0) !== 0) throw new Error("the model does not open");

const COUNT = 20;
function measure(resolution, polarised, grounded, altitude) {
  const once = (i) => {
    const error = wasm.prepare(0, altitude, 59400, 0.2, 0.3 + 0.01 * i, -1, polarised) || wasm.bake(0, ...resolution, polarised, grounded);
    if (error !== 0) throw new Error(`error ${error}`);
  };
  for (let i = 0; i < 5; i++) once(i);
  const before = process.cpuUsage();
  for (let i = 0; i < COUNT; i++) once(i);
  const { user, system } = process.cpuUsage(before);
  return (user + system) / 1e3 / COUNT;
}

console.log("table,polarised,ground,altitude_m,cpu_ms");
for (const resolution of [[24, 8, 16], [48, 24, 32]]) {
  for (const [polarised, grounded, altitude] of [[0, 0, 0], [0, 1, 0], [1, 1, 0], [0, 1, 10000]]) {
    const [up, down, azimuths] = resolution;
    console.log(`${up}+${down}x${azimuths},${polarised},${grounded},${altitude},${measure(resolution, polarised, grounded, altitude).toFixed(1)}`);
  }
}
