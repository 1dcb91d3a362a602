// The reader in WebAssembly, with types.

import { DISC_ROWS, DISC_TERMS } from "./disc";
import { Failure, unusable } from "./failure";
import type { Limits, Scene, SkyTables, Spectrum } from "./protocol";
import type { Destination, Range } from "./ranged_file";
import { AIR_DISTANCES, AIR_HEADER, type Air, type AirSize, CELLS, COLUMNS, type Land, RINGS, SUNLIGHT_COLUMNS, SUNLIGHT_ROWS } from "./terrain";

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
    phase: number,
    polarised: number,
  ): number;
  bake(index: number, up: number, down: number, azimuths: number, polarised: number, grounded: number): number;
  bake_space(
    index: number,
    visibility: number,
    albedo: number,
    low: number,
    high: number,
    step: number,
    up: number,
    down: number,
    columns: number,
    grounded: number,
  ): number;
  turbidity(index: number, visibility: number): number;
  radius(index: number): number;
  plan_air(index: number, visibility: number): number;
  bake_air(index: number, rows: number, columns: number, highest: number): number;
  air_at(): number;
  air_header_at(): number;
  sunlight_at(): number;
  terrain_open(index: number): number;
  terrain_look(index: number, camera: number): number;
  terrain_shade(elevation: number, azimuth: number): void;
  terrain_normals_at(): number;
  terrain_slopes_at(): number;
  terrain_shadows_at(): number;
  bake_disc(index: number): number;
  disc_at(): number;
  table_at(): number;
  header_at(): number;
  lattice_at(): number;
  answers_at(): number;
  look(index: number, x: number, y: number, z: number, first: number, step: number, count: number): number;
  error_text(error: number): number;
}

const HEADER = 12;
const LATTICE = 512;
/** Layers of the air from outside, in its coordinate of the sun: as fine as a table of this many intervals. */
const LAYER = 0.15;
const FINE = 48;
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
  /** The altitude for which ridges are there, and the tangent of the highest elevation of one. */
  #camera: number | null = null;
  #highest = 0;
  #landscape: { altitude: number; elevation: number; azimuth: number } | null = null;

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
      radius: this.wasm.radius(this.index),
      elevations: [this.wasm.elevation_limit(this.index, 0), this.wasm.elevation_limit(this.index, 1)],
    };
  }

  /** What a sky needs of the file. */
  plan(scene: Pick<Scene, "altitude" | "visibility" | "polarised" | "grounded" | "disc" | "air">, spectral: boolean): Range[] {
    const { altitude, visibility } = scene; // the altitude of where rays enter, from outside
    const [polarised, grounded] = [Number(scene.polarised), Number(scene.grounded)];
    this.#check(this.wasm.plan(this.index, altitude, visibility, polarised, grounded, Number(spectral)));
    if (scene.disc) this.#check(this.wasm.plan_disc(this.index));
    if (scene.air) this.#check(this.wasm.plan_air(this.index, visibility));
    const total = this.wasm.range_total();
    const list = new Float64Array(this.wasm.memory.buffer, this.wasm.range_list(), 2 * total);
    return Array.from({ length: total }, (_, i) => [list[2 * i]!, list[2 * i + 1]!]);
  }

  prepare({ altitude, visibility, albedo, elevation, phase, polarised }: Scene): void {
    this.#check(this.wasm.prepare(this.index, altitude, visibility, albedo, elevation, phase ?? -1, Number(polarised)));
  }

  bake(scene: Scene): Omit<SkyTables, "prepared" | "baked"> {
    return scene.reach === null ? this.#bakeSky(scene) : this.#bakeSpace(scene, scene.reach);
  }

  /** Of the air under a visibility (m). */
  turbidity(visibility: number): number {
    const found = this.wasm.turbidity(this.index, visibility);
    if (!(found > 0)) this.#check(-found);
    return found;
  }

  #bakeSpace({ visibility, albedo, elevation, resolution, grounded }: Scene, reach: number): Omit<SkyTables, "prepared" | "baked"> {
    const [up, down, columns] = [(2 * resolution[0]) / 3, resolution[1], (3 * resolution[2]) / 4];
    const [low, high, step] = [elevation - reach, elevation + reach, (LAYER * FINE) / resolution[0]];
    this.#check(
      this.wasm.bake_space(this.index, visibility, albedo, low, high, step, up, down, columns, Number(grounded)),
    );
    const header = this.#floats(this.wasm.header_at(), HEADER);
    header.set([up, down, columns], 7);
    const nodes = (header[6]! + 1) * (up + down + 2) * (columns + 1);
    return { header, root: this.#floats(this.wasm.table_at(), 4 * nodes), degrees: null, disc: null, air: null, lattice: new Float32Array() };
  }

  #bakeSky({ resolution, polarised, grounded, disc, air, altitude }: Scene): Omit<SkyTables, "prepared" | "baked"> {
    const [up, down, azimuths] = resolution;
    this.#check(this.wasm.bake(this.index, up, down, azimuths, Number(polarised), Number(grounded)));
    if (disc) this.#check(this.wasm.bake_disc(this.index));
    const before = air && this.#air(air, altitude);
    const nodes = (up + down + 2) * (azimuths + 1);
    const table = this.wasm.table_at();
    return {
      header: this.#floats(this.wasm.header_at(), HEADER),
      root: this.#floats(table, 4 * nodes),
      degrees: polarised ? this.#floats(table + 16 * nodes, 8 * nodes) : null,
      disc: disc ? this.#floats(this.wasm.disc_at(), DISC) : null,
      air: before,
      lattice: this.#floats(this.wasm.lattice_at(), LATTICE),
    };
  }

  /** The air before the landscape, for a camera so high (m). */
  #air([rows, columns]: AirSize, altitude: number): Air {
    this.#ridges(altitude);
    this.#check(this.wasm.bake_air(this.index, rows, columns, Math.min(Math.atan(this.#highest) + 0.01, 1.5)));
    return {
      header: this.#floats(this.wasm.air_header_at(), AIR_HEADER),
      table: this.#floats(this.wasm.air_at(), 8 * rows * columns * AIR_DISTANCES),
      sunlight: this.#floats(this.wasm.sunlight_at(), 4 * SUNLIGHT_COLUMNS * SUNLIGHT_ROWS),
    };
  }

  #ridges(altitude: number): void {
    if (this.#camera === altitude) return;
    if (!this.wasm.terrain_open(this.index)) throw unusable("scratch", this.url);
    this.#highest = this.wasm.terrain_look(this.index, altitude);
    this.#camera = altitude;
  }

  /** What differs from the landscape that was asked for last. */
  land(altitude: number, elevation: number, azimuth: number): Land {
    const last = this.#landscape;
    this.#ridges(altitude);
    const isShaded = last?.elevation === elevation && last?.azimuth === azimuth;
    if (!isShaded) this.wasm.terrain_shade(elevation, azimuth);
    this.#landscape = { altitude, elevation, azimuth };
    return {
      normals: last ? null : this.#floats(this.wasm.terrain_normals_at(), 2 * COLUMNS * RINGS),
      slopes: last?.altitude === altitude ? null : this.#floats(this.wasm.terrain_slopes_at(), COLUMNS * RINGS),
      shadows: isShaded ? null : this.#floats(this.wasm.terrain_shadows_at(), CELLS * CELLS),
    };
  }

  #floats(at: number, length: number): Float32Array<ArrayBuffer> {
    return new Float32Array(this.wasm.memory.buffer, at, length).slice();
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
