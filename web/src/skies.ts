// Asks the worker, for one thing at a time: of wishes that come meanwhile, the last counts.

import { Failure } from "./failure";
import type { Answer, Limits, Look, Question, Scene, SkyTables, Spectrum, Traffic } from "./protocol";
import type { Land } from "./terrain";

type Without<T> = T extends { id: number } ? Omit<T, "id"> : never;

export class Skies {
  readonly #worker: Worker;
  readonly #waiting = new Map<number, { resolve(answer: Answer): void; reject(error: Error): void }>();
  #count = 0;

  constructor(url: string, onTraffic: (traffic: Traffic) => void) {
    this.#worker = new Worker(url, { type: "module" });
    this.#worker.addEventListener("message", ({ data }: MessageEvent<Answer>) => {
      if (data.kind === "traffic") return onTraffic(data.traffic);
      const waiting = this.#waiting.get(data.id);
      this.#waiting.delete(data.id);
      if (data.kind === "failed") waiting?.reject(new Failure(data.message));
      else waiting?.resolve(data);
    });
    this.#worker.addEventListener("error", (event) => {
      event.preventDefault();
      const failure = new Failure(`The page's worker does not run: ${event.message || "its code cannot be fetched"}.`);
      for (const { reject } of this.#waiting.values()) reject(failure);
      this.#waiting.clear();
    });
  }

  async open(files: { colours: string; spectra: string; code: string }): Promise<Limits> {
    return (await this.#ask({ kind: "open", ...files }, "opened")).limits;
  }

  async sky(scene: Scene): Promise<SkyTables> {
    return (await this.#ask({ kind: "sky", scene }, "sky")).tables;
  }

  async look(lights: Look[], spectral: boolean): Promise<Spectrum> {
    return (await this.#ask({ kind: "look", lights, spectral }, "look")).spectrum;
  }

  async turbidity(visibility: number): Promise<number> {
    return (await this.#ask({ kind: "turbidity", visibility }, "turbidity")).turbidity;
  }

  /** What changed of the landscape since the last question. */
  async land(altitude: number, elevation: number, azimuth: number): Promise<Land> {
    return (await this.#ask({ kind: "land", altitude, elevation, azimuth }, "land")).land;
    }

  #ask<K extends Answer["kind"]>(question: Without<Question>, kind: K): Promise<Extract<Answer, { kind: K }>> {
    const id = ++this.#count;
    return new Promise((resolve, reject) => {
      const done = (answer: Answer) => {
        if (answer.kind === kind) resolve(answer as Extract<Answer, { kind: K }>);
        else reject(new Failure(`The worker answers ${answer.kind} to ${kind}.`));
      };
      this.#waiting.set(id, { resolve: done, reject });
      this.#worker.postMessage({ ...question, id });
    });
  }

  close(): void {
    this.#worker.terminate();
  }
}

/** Runs the last of the wishes that come while one runs. */
export class Latest {
  #next: (() => Promise<void>) | null = null;
  #isRunning = false;

  get isIdle(): boolean {
    return !this.#isRunning;
  }

  async run(action: () => Promise<void>): Promise<void> {
    this.#next = action;
    if (this.#isRunning) return;
    this.#isRunning = true;
    try {
      while (this.#next) {
        const now = this.#next;
        this.#next = null;
        await now();
      }
    } finally {
      this.#isRunning = false;
    }
  }
}
