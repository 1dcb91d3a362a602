// Draws the sky with WebGL2.

import { DISC_ROWS, DISC_TERMS, discBox, discParts, sunDirection } from "./disc";
import { aspect, cameraAxes } from "./directions";
import { Failure } from "./failure";
import type { SkyTables } from "./protocol";
import { FRAGMENT, VERTEX } from "./shader";
import { AIR_DISTANCES, AIR_HEADER, type Air, CELLS, COLUMNS, type Land, RINGS, SUNLIGHT_COLUMNS, SUNLIGHT_ROWS } from "./terrain";
import { BALANCES, PROJECTIONS, QUANTITIES, TONES, type View } from "./view";

const RADIANS = Math.PI / 180;
/** Luminance of scene white at exposure value 0 (ISO 100), cd m⁻², and what a sky's mean is of white. */
const WHITE_AT_EV_0 = 1.2;
const SKY = 0.36;
/** Textures: square roots, degrees, (2 is the target of `light`), the sun's disc. */
const DISC_UNIT = 5;
const [SLOPES, NORMALS, SHADOWS, AIR, SUNLIGHT] = [6, 7, 8, 9, 10] as const;
const UNITS = [0, 1, DISC_UNIT, SLOPES, NORMALS, SHADOWS, AIR, SUNLIGHT];

const NAMES = [
  "roots", "degrees", "size", "projection", "axes", "half_field", "horizon", "ends", "intervals", "sun", "quantity",
  "polariser", "has_polariser", "white", "tone", "is_daylight", "disc", "disc_axis", "disc_sun", "disc_box", "disc_parts",
  "slopes", "normals", "shadows", "air", "sunlight", "land", "land_sun",
] as const;

const LAND = [
  ["slopes", SLOPES, COLUMNS, RINGS],
  ["normals", NORMALS, COLUMNS, RINGS],
  ["shadows", SHADOWS, CELLS, CELLS],
] as const;

type Places = Record<(typeof NAMES)[number], WebGLUniformLocation | null>;

export interface Pixels {
  width: number;
  height: number;
  /** R, G, B and 1, cd m⁻², from the bottom up. */
  light: Float32Array;
}

export class Renderer {
  readonly #gl: WebGL2RenderingContext;
  readonly #canvas: HTMLCanvasElement;
  #places!: Places;
  #textures: WebGLTexture[] = [];
  #tables: SkyTables | null = null;
  #land: Land = { normals: null, slopes: null, shadows: null };
  /** Of the canvas on the page; to ask it in each frame would lay the page out each time. */
  #cssHeight: number;

  constructor(canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: false, depth: false, preserveDrawingBuffer: true });
    if (!gl) throw new Failure("This browser does not give the page WebGL2, with which the sky is drawn.");
    this.#gl = gl;
    this.#canvas = canvas;
    this.#cssHeight = canvas.clientHeight;
    new ResizeObserver(() => {
      this.#cssHeight = canvas.clientHeight;
      canvas.dispatchEvent(new Event("redraw"));
    }).observe(canvas);
    this.#build();
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => {
      this.#build();
      if (this.#tables) this.upload(this.#tables);
      this.uploadLand(this.#land);
      canvas.dispatchEvent(new Event("redraw"));
    });
  }

  get hasSky(): boolean {
    return this.#tables !== null;
  }

  /** Exposure value of the picture. */
  exposure(view: View): number {
    return view.exposure ?? Math.log2((this.#tables?.mean ?? 1) / SKY / WHITE_AT_EV_0);
  }

  upload(tables: SkyTables): void {
    const [rows, columns] = [tables.header[7]! + tables.header[8]! + 2, tables.header[9]! + 1];
    this.#texture(0, columns, rows, tables.root);
    if (tables.degrees) this.#texture(1, 2 * columns, rows, tables.degrees);
    if (tables.disc) this.#texture(DISC_UNIT, DISC_TERMS, DISC_ROWS, tables.disc.subarray(4));
    if (tables.air) this.#uploadAir(tables.air);
    this.#tables = tables;
  }

  #uploadAir({ header, table, sunlight }: Air): void {
    const [rows, columns] = [header[3]!, header[4]!];
    this.#texture(AIR, 2 * columns, rows * AIR_DISTANCES, table);
    this.#texture(SUNLIGHT, SUNLIGHT_COLUMNS, SUNLIGHT_ROWS, sunlight);
  }

  uploadLand(land: Land): void {
    const all = { ...this.#land };
    for (const [key, unit, width, height] of LAND) {
      const values = land[key];
      if (!values) continue;
      this.#texture(unit, width, height, values);
      all[key] = values;
    }
    this.#land = all;
  }

  draw(view: View): void {
    const height = view.size ?? Math.max(1, Math.round(this.#cssHeight * Math.min(devicePixelRatio, 2)));
    const width = Math.round(height * aspect(view.projection));
    if (this.#canvas.width !== width) this.#canvas.width = width;
    if (this.#canvas.height !== height) this.#canvas.height = height;
    this.#gl.bindFramebuffer(this.#gl.FRAMEBUFFER, null);
    this.#paint(view, width, height, TONES.indexOf(view.tone));
  }

  /** The light of the picture, in linear sRGB. */
  light(view: View): Pixels {
    const gl = this.#gl;
    if (!gl.getExtension("EXT_color_buffer_float")) throw new Failure("This device cannot draw in floating point.");
    const { width, height } = this.#canvas;
    const [target, buffer] = [gl.createTexture(), gl.createFramebuffer()];
    gl.activeTexture(gl.TEXTURE2);
    gl.bindTexture(gl.TEXTURE_2D, target);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
    const light = new Float32Array(4 * width * height);
    this.#paint({ ...view, quantity: "radiance" }, width, height, -1);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, light);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(buffer);
    gl.deleteTexture(target);
    return { width, height, light };
  }

  #paint(view: View, width: number, height: number, tone: number): void {
    const tables = this.#tables;
    if (!tables) return;
    const gl = this.#gl;
    const at = this.#places;
    const h = tables.header;
    gl.viewport(0, 0, width, height);
    gl.uniform2f(at.size, width, height);
    gl.uniform1i(at.projection, PROJECTIONS.indexOf(view.projection));
    gl.uniformMatrix3fv(at.axes, false, cameraAxes(view).flat());
    gl.uniform1f(at.half_field, Math.tan((view.field * RADIANS) / 2));
    gl.uniform4f(at.horizon, h[0]!, h[1]!, h[2]!, h[3]!);
    gl.uniform3f(at.ends, h[4]!, h[5]!, h[6]!);
    gl.uniform3i(at.intervals, h[7]!, h[8]!, h[9]!);
    gl.uniform2f(at.sun, Math.cos(view.sunAzimuth * RADIANS), Math.sin(view.sunAzimuth * RADIANS));
    const hasDegrees = tables.degrees !== null;
    gl.uniform1i(at.quantity, hasDegrees ? QUANTITIES.indexOf(view.quantity) : 0);
    gl.uniform1i(at.has_polariser, Number(hasDegrees && view.polariser !== null));
    gl.uniform1f(at.polariser, (view.polariser ?? 0) * RADIANS);
    gl.uniform1f(at.white, WHITE_AT_EV_0 * 2 ** this.exposure(view));
    gl.uniform1i(at.tone, tone);
    gl.uniform1i(at.is_daylight, Number(BALANCES[0] === view.balance));
    this.#placeDisc(view, width, height);
    this.#placeLand(view);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  #placeLand(view: View): void {
    const [gl, at, { air, header }] = [this.#gl, this.#places, this.#tables!];
    const values = new Float32Array(AIR_HEADER);
    if (air) values.set(air.header);
    values[18] = Number(air !== null && this.#land.slopes !== null);
    values[19] = Number(view.ground === "lit");
    gl.uniform4fv(at.land, values);
    gl.uniform3f(at.land_sun, ...sunDirection(view, header[10]));
  }

  #placeDisc(view: View, width: number, height: number): void {
    const { disc, header } = this.#tables!;
    const [gl, at] = [this.#gl, this.#places];
    if (!disc) return gl.uniform4f(at.disc_axis, 0, 0, 0, 1);
    const sun = sunDirection(view, header[10]);
    const box = discBox(view, sun);
    const pixels = box.map((edge, i) => ((edge + 1) / 2) * (i % 2 === 0 ? width : height));
    gl.uniform4f(at.disc_axis, disc[0]!, disc[1]!, disc[2]!, disc[3]!);
    gl.uniform3f(at.disc_sun, ...sun);
    gl.uniform4f(at.disc_box, pixels[0]!, pixels[1]!, pixels[2]!, pixels[3]!);
    gl.uniform1i(at.disc_parts, discParts(box, width, height));
  }

  #build(): void {
    const gl = this.#gl;
    const program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]] as const) {
      const shader = gl.createShader(type);
      if (!shader) throw new Failure("The graphics device is gone.");
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      const logs = (gl.getAttachedShaders(program) ?? []).map((shader) => gl.getShaderInfoLog(shader));
      throw new Failure(`The sky's shader does not run here: ${[gl.getProgramInfoLog(program), ...logs].join(" ")}`);
    }
    gl.useProgram(program);
    const places = NAMES.map((name) => [name, gl.getUniformLocation(program, name)] as const);
    this.#places = Object.fromEntries(places) as Places;
    gl.uniform1i(this.#places.roots, 0);
    gl.uniform1i(this.#places.degrees, 1);
    gl.uniform1i(this.#places.disc, DISC_UNIT);
    for (const [name, unit] of LAND) gl.uniform1i(this.#places[name], unit);
    gl.uniform1i(this.#places.air, AIR);
    gl.uniform1i(this.#places.sunlight, SUNLIGHT);
    this.#textures = [];
    const nothing = new Float32Array(4);
    for (const unit of UNITS) this.#textures[unit] = gl.createTexture();
    for (const unit of UNITS) this.#texture(unit, 1, 1, nothing);
  }

  #texture(unit: number, width: number, height: number, values: Float32Array): void {
    const gl = this.#gl;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, this.#textures[unit]!);
    const channels = values.length / (width * height);
    const [inner, format] =
      channels === 1 ? [gl.R32F, gl.RED] : channels === 2 ? [gl.RG32F, gl.RG] : ([gl.RGBA32F, gl.RGBA] as const);
    gl.texImage2D(gl.TEXTURE_2D, 0, inner, width, height, 0, format, gl.FLOAT, values);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }
}
