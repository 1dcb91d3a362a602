// Fetches and computes, away from the page.

import { Failure, message } from "./failure";
import type { Answer, Question, Scene, SkyTables, Spectrum, Traffic } from "./protocol";
import { RangedFile } from "./ranged_file";
import { Reader, type ReaderFile } from "./reader";

/** The first request: the heads of both files that `build` makes and, of that for colours, all that every sky needs. */
const START = 86_016;

const traffic: Traffic = { requests: 0, bytes: 0, total: 0 };

const say = (answer: Answer, transfer: Transferable[] = []) => postMessage(answer, { transfer });

/** A model that grows as it is asked. */
class Model {
  #isOpen = false;
  #ranged: RangedFile;

  constructor(
    readonly file: ReaderFile,
    url: string,
  ) {
    this.#ranged = new RangedFile(url, file, traffic, () => say({ kind: "traffic", traffic: { ...traffic } }));
  }

  /** The head. */
  async open(): Promise<void> {
    if (this.#isOpen) return;
    await this.#safely(async () => {
      await this.#ranged.need([[0, START]]);
      const head = this.#ranged.length >= 32 ? this.file.headLength() : 0;
      if (head > START && head <= this.#ranged.length) await this.#ranged.need([[0, head]]);
      this.file.open();
      this.#isOpen = true;
    });
  }

  /** The sky of a scene, ready to be asked; how long that took without what had to be fetched, ms. */
  async prepare(scene: Scene, spectral: boolean): Promise<number> {
    await this.open();
    let start = 0;
    await this.#safely(async () => {
      if (await this.#ranged.need(this.file.plan(scene, spectral))) this.file.open();
      start = performance.now();
      if (scene.reach === null) this.file.prepare(scene);
    });
    return performance.now() - start;
  }

  /** What its transmittance needs. */
  async air(visibility: number): Promise<void> {
    const scene = { altitude: 0, visibility, polarised: false, grounded: true, disc: false, air: null };
    await this.open();
    await this.#safely(async () => {
      if (await this.#ranged.need(this.file.plan(scene, false))) this.file.open();
    });
  }

  /** After a failure all is fetched anew: the file may be repaired. */
  async #safely(action: () => Promise<void>): Promise<void> {
    try {
      await action();
    } catch (error) {
      this.#isOpen = false;
      this.#ranged.forget();
      throw error;
    }
  }
}

let colours: Model | undefined;
let spectra: Model | undefined;

async function open(question: Extract<Question, { kind: "open" }>): Promise<Answer> {
  const reader = await Reader.load(question.code);
  colours = new Model(reader.file(0, question.colours), question.colours);
  spectra = new Model(reader.file(1, question.spectra), question.spectra);
  await colours.open();
  return { kind: "opened", id: question.id, limits: colours.file.limits() };
}

function opened(model: Model | undefined): Model {
  if (!model) throw new Failure("No model is open.");
  return model;
}

async function sky(scene: Scene): Promise<SkyTables> {
  const model = opened(colours);
  const prepared = await model.prepare(scene, false);
  const start = performance.now();
  const tables = model.file.bake(scene);
  return { ...tables, prepared, baked: performance.now() - start };
}

/** The sum of the lights. */
async function look({ lights, spectral }: Extract<Question, { kind: "look" }>): Promise<Spectrum> {
  const model = opened(spectral ? spectra : colours);
  let sum: Spectrum | undefined;
  for (const { scene, direction } of lights) {
    await model.prepare({ ...scene, polarised: true, grounded: false, reach: null, disc: false, air: null }, spectral);
    const one = model.file.look(direction, spectral);
    if (sum) one.forEach((value, i) => i % 4 && (sum![i]! += value));
    else sum = one;
  }
  return sum ?? new Float64Array();
}

async function turbidity({ visibility }: Extract<Question, { kind: "turbidity" }>): Promise<number> {
  const model = opened(colours);
  await model.air(visibility);
  return model.file.turbidity(visibility);
}

const buffers = (all: (Float32Array | null)[]) => all.flatMap((values) => (values ? [values.buffer] : []));

async function answer(question: Question): Promise<void> {
  if (question.kind === "open") return say(await open(question));
  if (question.kind === "look") return say({ kind: "look", id: question.id, spectrum: await look(question) });
  if (question.kind === "turbidity") return say({ kind: "turbidity", id: question.id, turbidity: await turbidity(question) });
  if (question.kind === "land") {
    const model = opened(colours);
    await model.open();
    const land = model.file.land(question.altitude, question.elevation, question.azimuth);
    return say({ kind: "land", id: question.id, land }, buffers([land.normals, land.slopes, land.shadows]));
  }
  const tables = await sky(question.scene);
  const { header, root, lattice, degrees, disc, air } = tables;
  const transfer = buffers([header, root, lattice, degrees, disc, ...(air ? [air.header, air.table, air.sunlight] : [])]);
  say({ kind: "sky", id: question.id, tables }, transfer);
}

// One after the other: questions share the memory of the reader.
let last = Promise.resolve();
addEventListener("message", ({ data }: MessageEvent<Question>) => {
  last = last
    .then(() => answer(data))
    .catch((error: unknown) => say({ kind: "failed", id: data.id, message: message(error) }));
});
