// A file of which only what is needed is fetched, by HTTP ranges.

import { Failure, message } from "./failure";
import type { Traffic } from "./protocol";

export type Range = readonly [offset: number, length: number];

/** Where the bytes go: memory of this length, asked for once. */
export interface Destination {
  reserve(length: number): void;
  write(offset: number, bytes: Uint8Array): void;
}

/** Ranges that are so close are one request: a request costs more than the bytes between. */
const GAP = 2048;
const LONGEST = 1 << 29;

export class RangedFile {
  #length: number | null = null;
  #have: Range[] = [];
  #isCounted = false;

  constructor(
    readonly url: string,
    private readonly to: Destination,
    private readonly traffic: Traffic,
    private readonly changed: () => void,
  ) {}

  get length(): number {
    return this.#length ?? 0;
  }

  /** Whether something had to be fetched. */
  async need(wanted: Range[]): Promise<boolean> {
    const missing = merged(wanted.filter((range) => !this.#has(range)));
    await Promise.all(missing.map((range) => this.#fetch(range)));
    return missing.length > 0;
  }

  /** What was fetched is fetched again when it is needed. */
  forget(): void {
    this.#have = [];
    this.#length = null;
  }

  #has([offset, length]: Range): boolean {
    return this.#have.some(([start, size]) => start <= offset && offset + length <= start + size);
  }

  async #fetch([offset, length]: Range): Promise<void> {
    const last = offset + length - 1;
    const response = await this.#request(`bytes=${offset}-${last}`);
    const bytes = new Uint8Array(await this.#body(response));
    const isPart = response.status === 206;
    const start = isPart ? this.#start(response, offset) : 0;
    if (!isPart) this.#setLength(bytes.length);
    if (isPart && bytes.length !== Math.min(length, this.length - offset)) {
      throw new Failure(`The model ${this.url} came in part only: the server or the connection stopped.`);
    }
    this.to.write(start, bytes);
    this.#have = merged([...this.#have, [start, bytes.length]], 0);
    this.traffic.bytes += bytes.length;
    this.changed();
  }

  async #request(range: string): Promise<Response> {
    this.traffic.requests++;
    let response: Response;
    try {
      response = await fetch(this.url, { headers: { Range: range } });
    } catch (error) {
      throw new Failure(`The model ${this.url} cannot be fetched: no connection to the server (${message(error)}).`);
    }
    if (response.status !== 206 && response.status !== 200) {
      throw new Failure(`The model ${this.url} cannot be fetched: the server says ${response.status}.`);
    }
    return response;
  }

  async #body(response: Response): Promise<ArrayBuffer> {
    try {
      return await response.arrayBuffer();
    } catch (error) {
      throw new Failure(`The model ${this.url} came in part only: the connection broke (${message(error)}).`);
    }
  }

  /** Where the part starts; says how long the file is. */
  #start(response: Response, offset: number): number {
    const found = /^bytes (\d+)-\d+\/(\d+)$/.exec(response.headers.get("Content-Range") ?? "");
    if (!found || Number(found[1]) !== offset) {
      throw new Failure(`The server does not say which part of ${this.url} it sends.`);
    }
    this.#setLength(Number(found[2]));
    return offset;
  }

  #setLength(length: number): void {
    if (this.#length === length) return;
    if (this.#length !== null) {
      this.forget();
      throw new Failure(`The model ${this.url} changed on the server.`);
    }
    if (length === 0 || length > LONGEST) throw new Failure(`The model ${this.url} is ${length} bytes long.`);
    this.to.reserve(length);
    this.#length = length;
    if (!this.#isCounted) this.traffic.total += length;
    this.#isCounted = true;
  }
}

/** In order, and what is close together as one. */
export function merged(ranges: Range[], gap = GAP): Range[] {
  const sorted = [...ranges].sort((a, b) => a[0] - b[0]);
  const out: Range[] = [];
  for (const [offset, length] of sorted) {
    const before = out.at(-1);
    if (before && offset <= before[0] + before[1] + gap) {
      const end = Math.max(before[0] + before[1], offset + length);
      out[out.length - 1] = [before[0], end - before[0]];
    } else {
      out.push([offset, length]);
    }
  }
  return out;
}
