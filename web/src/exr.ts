// OpenEXR files of 32-bit floats without compression.

import type { Pixels } from "./renderer";

class Bytes {
  #parts: Uint8Array[] = [];
  length = 0;

  add(part: Uint8Array): this {
    this.#parts.push(part);
    this.length += part.length;
    return this;
  }

  text(text: string): this {
    return this.add(new TextEncoder().encode(`${text}\0`));
  }

  ints(...values: number[]): this {
    const view = new DataView(new ArrayBuffer(4 * values.length));
    values.forEach((value, i) => view.setInt32(4 * i, value, true));
    return this.add(new Uint8Array(view.buffer));
  }

  floats(...values: number[]): this {
    const view = new DataView(new ArrayBuffer(4 * values.length));
    values.forEach((value, i) => view.setFloat32(4 * i, value, true));
    return this.add(new Uint8Array(view.buffer));
  }

  attribute(name: string, type: string, value: Bytes): this {
    return this.text(name).text(type).ints(value.length).add(value.joined());
  }

  joined(): Uint8Array<ArrayBuffer> {
    const out = new Uint8Array(this.length);
    let at = 0;
    for (const part of this.#parts) {
      out.set(part, at);
      at += part.length;
    }
    return out;
  }
}

const MAGIC = 20000630;
const VERSION = 2;
const FLOAT = 2;
/** In the order of the file. */
const CHANNELS = ["B", "G", "R"];

function header({ width, height }: Pixels): Bytes {
  const channels = new Bytes();
  for (const name of CHANNELS) channels.text(name).ints(FLOAT, 0, 1, 1);
  channels.add(new Uint8Array(1));
  const box = () => new Bytes().ints(0, 0, width - 1, height - 1);
  const byte = () => new Bytes().add(new Uint8Array(1));
  return new Bytes()
    .ints(MAGIC, VERSION)
    .attribute("channels", "chlist", channels)
    .attribute("compression", "compression", byte())
    .attribute("dataWindow", "box2i", box())
    .attribute("displayWindow", "box2i", box())
    .attribute("lineOrder", "lineOrder", byte())
    .attribute("pixelAspectRatio", "float", new Bytes().floats(1))
    .attribute("screenWindowCenter", "v2f", new Bytes().floats(0, 0))
    .attribute("screenWindowWidth", "float", new Bytes().floats(1))
    .add(new Uint8Array(1));
}

/** A file of pixels that count from the bottom up. */
export function exr(pixels: Pixels): Uint8Array<ArrayBuffer> {
  const { width, height, light } = pixels;
  const out = header(pixels);
  const line = 4 * CHANNELS.length * width;
  const start = out.length + 8 * height;
  for (let y = 0; y < height; y++) {
    const at = start + y * (8 + line);
    out.ints(at % 2 ** 32, Math.floor(at / 2 ** 32));
  }
  for (let y = 0; y < height; y++) {
    const view = new DataView(new ArrayBuffer(line));
    const row = 4 * width * (height - 1 - y);
    for (let c = 0; c < 3; c++) {
      for (let x = 0; x < width; x++) view.setFloat32(4 * (c * width + x), light[row + 4 * x + 2 - c]!, true);
    }
    out.ints(y, line).add(new Uint8Array(view.buffer));
  }
  return out.joined();
}
