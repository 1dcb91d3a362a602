// The reader in WebAssembly, with types.

import { DISC_ROWS, DISC_TERMS } from "./disc";
import { Failure, unusable } from "./failure";
import type { Limits, Scene, SkyTables, Spectrum } from "./protocol";
import type { Destination, Range } from "./ranged_file";

interface Exports {
  memory: WebAssembly.Memory;
  reserve(index: number, length: number): number;
  open_file(index: number): number;
  count_of(index: number, what: number): number;
  node_of(index: number, what: number, node: number): number;
  elevation_limit(index: number, highest: number): number;
  plan(
    index: number,
    altitude: number,
    visibility: number,
    polarised: number,
    grounded: number,
    spectral: number,
  ): number;
  plan_disc(index: number): number;
  range_total(): number;
  range_list(): number;
  prepare(
    index: number,
    altitude: number,
    visibility: number,
    albedo: number,
    elevation: number,
    polarised: number,
  ): number;
  bake(index: number, up: number, down: number, azimuths: number, polarised: number, grounded: number): number;
  bake_disc(index: number): number;
  disc_at(): number;
  table_at(): number;
  header_at(): number;
  mean_of(index: number): number;
  answers_at(): number;
  look(index: number, x: number, y: number, z: number, first: number, step: number, count: number): number;
  error_text(error: number): number;
}

const HEADER = 12;
/** Of the disc: header, and coefficients by elevation. */
const DISC = 4 + 4 * DISC_TERMS * DISC_ROWS;
/** Wavelengths of a spectrum between the nodes, nm. */
const FIRST = 300;
const STEP = 5;
const COUNT = 161;

export class Reader {
  private constructor(private readonly wasm: Exports) {}

  static async load(url: string): Promise<Reader> {
    let bytes: ArrayBuffer;
    try {
      const response = await fetch(url);
      if (!response.ok) throw new Failure(`the server says ${response.status}`);
      bytes = await response.arrayBuffer();
    } catch (error) {
      throw new Failure(`The code ${url} cannot be fetched: ${error instanceof Error ? error.message : error}.`);
    }
    const { instance } = await WebAssembly.instantiate(bytes, {});
    return new Reader(instance.exports as unknown as Exports);
  }

  /** One of the two files that may be open. */
  file(index: number, url: string): ReaderFile {
    return new ReaderFile(this.wasm, index, url);
  }
}

export class ReaderFile implements Destination {
  #base = 0;

  constructor(
    private readonly wasm: Exports,
    private readonly index: number,
    private readonly url: string,
  ) {}

  reserve(length: number): void {
    this.#base = this.wasm.reserve(this.index, length);
    if (!this.#base) throw unusable("scratch", this.url);
  }

  write(offset: number, bytes: Uint8Array): void {
    new Uint8Array(this.wasm.memory.buffer).set(bytes, this.#base + offset);
  }

  /** How long the head says that it is. */
  headLength(): number {
    const head = new DataView(this.wasm.memory.buffer, this.#base);
    return head.getUint32(24, true) + head.getUint32(28, true) * 2 ** 32;
  }

  open(): void {
    this.#check(this.wasm.open_file(this.index));
  }

  limits(): Limits {
    const nodes = (what: number) =>
      Array.from({ length: this.wasm.count_of(this.index, what) }, (_, i) => this.wasm.node_of(this.index, what, i));
    return {
      altitudes: nodes(1),
      visibilities: nodes(2),
      elevations: [this.wasm.elevation_limit(this.index, 0), this.wasm.elevation_limit(this.index, 1)],
    };
  }

  /** What a sky needs of the file. */
  plan(scene: Scene, spectral: boolean): Range[] {
    const { altitude, visibility } = scene;
    const [polarised, grounded] = [Number(scene.polarised), Number(scene.grounded)];
    this.#check(this.wasm.plan(this.index, altitude, visibility, polarised, grounded, Number(spectral)));
    if (scene.disc) this.#check(this.wasm.plan_disc(this.index));
    const total = this.wasm.range_total();
    const list = new Float64Array(this.wasm.memory.buffer, this.wasm.range_list(), 2 * total);
    return Array.from({ length: total }, (_, i) => [list[2 * i]!, list[2 * i + 1]!]);
  }

  prepare({ altitude, visibility, albedo, elevation, polarised }: Scene): void {
    this.#check(this.wasm.prepare(this.index, altitude, visibility, albedo, elevation, Number(polarised)));
  }

  bake({ resolution, polarised, grounded, disc }: Scene): Omit<SkyTables, "prepared" | "baked"> {
    const [up, down, azimuths] = resolution;
    this.#check(this.wasm.bake(this.index, up, down, azimuths, Number(polarised), Number(grounded)));
    if (disc) this.#check(this.wasm.bake_disc(this.index));
    const nodes = (up + down + 2) * (azimuths + 1);
    const floats = (at: number, length: number) => new Float32Array(this.wasm.memory.buffer, at, length).slice();
    const table = this.wasm.table_at();
    return {
      header: floats(this.wasm.header_at(), HEADER),
      root: floats(table, 4 * nodes),
      degrees: polarised ? floats(table + 16 * nodes, 8 * nodes) : null,
      disc: disc ? floats(this.wasm.disc_at(), DISC) : null,
      mean: this.wasm.mean_of(this.index),
    };
  }

  /** At the wavelengths of the file, or between them. */
  look([x, y, z]: readonly [number, number, number], spectral: boolean): Spectrum {
    const count = this.wasm.look(this.index, x, y, z, FIRST, spectral ? STEP : 0, COUNT);
    if (count < 0) this.#check(-count);
    return new Float64Array(this.wasm.memory.buffer, this.wasm.answers_at(), 4 * count).slice();
  }

  #check(error: number): void {
    if (error === 0) return;
    const bytes = new Uint8Array(this.wasm.memory.buffer);
    const start = this.wasm.error_text(error);
    const name = new TextDecoder().decode(bytes.slice(start, bytes.indexOf(0, start)));
    throw unusable(name, this.url);
  }
}
