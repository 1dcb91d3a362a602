// Draws the sky with WebGL2.

import { aspect, cameraMatrix, sunVector } from "./directions";
import { Failure } from "./failure";
import type { Coefficients } from "./hosek";
import { WHITE_AT_EV_0, whiteOfPixels, whiteOfSky } from "./metering";
import type { SkyTables } from "./protocol";
import { FRAGMENT, VERTEX } from "./shader";
import { Uniforms } from "./uniforms";
import { BALANCES, PROJECTIONS, QUANTITIES, TONES, type View } from "./view";

const RADIANS = Math.PI / 180;
/** Textures: square roots and degrees of each light. 2 is the target of `light`. */
const UNITS = { sun: [0, 1], moon: [8, 9], space: [10, 11] } as const;
const SAMPLERS = { roots: 0, degrees: 1, moon_roots: 8, moon_degrees: 9, space_roots: 10 };
const NONE = new Float32Array(12);
/** What is seen from space is exposed by a picture of that height at most. */
const METERED = 128;

/** What the sky is lit by, or the air seen from outside. */
export type Source = keyof typeof UNITS;

/** From outside of the air: how far away, of the distance of where rays enter it, from the planet's centre. */
export type Eye = number | null;

/** Names of a light's uniforms. */
const place = (name: string) => ({
  horizon: `${name}.horizon`,
  ends: `${name}.ends`,
  intervals: `${name}.intervals`,
  azimuth: `${name}.azimuth`,
});
const PLACES = { sun: place("sun"), moon: place("moon") };

export interface Pixels {
  width: number;
  height: number;
  /** R, G, B and 1, cd m⁻², from the bottom up. */
  light: Float32Array;
}

export class Renderer {
  readonly #gl: WebGL2RenderingContext;
  readonly #canvas: HTMLCanvasElement;
  #uniforms!: Uniforms;
  readonly #textures = new Map<number, WebGLTexture>();
  readonly #tables = new Map<Source, SkyTables>();
  #isReady = false;
  #hasDegrees = false;
  #eye: Eye = null;
  #other: Coefficients | null = null;
  /** White where it is automatic, cd m⁻², and the azimuth between the lights that it is for. */
  #white = WHITE_AT_EV_0;
  #between = NaN;
  /** Of the canvas on the page; to ask it in each frame would lay the page out each time. */
  #cssHeight: number;
  readonly #axes = new Float32Array(9);

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
      for (const [source, tables] of this.#tables) this.#upload(source, tables);
      canvas.dispatchEvent(new Event("redraw"));
    });
  }

  get hasSky(): boolean {
    return this.#isReady;
  }

  /** Exposure value of the picture. */
  exposure(view: View): number {
    return view.exposure ?? Math.log2(this.#automatic(view) / WHITE_AT_EV_0);
  }

  #automatic(view: View): number {
    const between = view.moonAzimuth - view.sunAzimuth;
    if (this.#eye !== null || between === this.#between) return this.#white;
    const lights = (["sun", "moon"] as const).flatMap((source) => {
      const lattice = this.#tables.get(source)?.lattice;
      return lattice ? [{ lattice, azimuth: view[`${source}Azimuth`] * RADIANS }] : [];
    });
    this.#white = whiteOfSky(lights);
    this.#between = between;
    return this.#white;
  }

  /** Looks how bright what is seen from space is: that takes the picture itself. */
  meter(view: View): void {
    if (this.#eye === null || view.exposure !== null || !this.#gl.getExtension("EXT_color_buffer_float")) return;
    const height = Math.min(this.#height(view), METERED);
    const light = this.#lightOf(view, Math.round(height * aspect(view.projection)), height);
    this.#white = whiteOfPixels(light.light);
  }

  /** Sets one of the tables, or takes it away. */
  set(source: Source, tables: SkyTables | null): void {
    this.#between = NaN;
    if (!tables) {
      this.#tables.delete(source);
      return;
    }
    this.#upload(source, tables);
    this.#tables.set(source, tables);
  }

  /** All tables are there: what has none is black. */
  place(eye: Eye): void {
    if (eye !== this.#eye) this.#between = NaN;
    this.#eye = eye;
    this.#isReady = true;
    this.#hasDegrees = eye === null && [...this.#tables.values()].some(({ degrees }) => degrees !== null);
  }

  /** What stands to the right of the divider. */
  beside(other: Coefficients | null): void {
    this.#other = other;
  }

  #upload(source: Source, { header: h, root, degrees }: SkyTables): void {
    const [roots, polarised] = UNITS[source];
    if (source === "space") {
      const columns = h[9]! + 1;
      return this.#texture(roots, columns, root.length / 4 / columns, root);
    }
    const [rows, columns] = [h[7]! + h[8]! + 2, h[9]! + 1];
    this.#texture(roots, columns, rows, root);
    if (degrees) this.#texture(polarised, 2 * columns, rows, degrees);
  }

  #height(view: View): number {
    return view.size ?? Math.max(1, Math.round(this.#cssHeight * Math.min(devicePixelRatio, 2)));
  }

  draw(view: View): void {
    const height = this.#height(view);
    const width = Math.round(height * aspect(view.projection));
    if (this.#canvas.width !== width) this.#canvas.width = width;
    if (this.#canvas.height !== height) this.#canvas.height = height;
    this.#gl.bindFramebuffer(this.#gl.FRAMEBUFFER, null);
    this.#paint(view, width, height, TONES.indexOf(view.tone));
  }

  /** The light of the picture, in linear sRGB. */
  light(view: View): Pixels {
    return this.#lightOf(view, this.#canvas.width, this.#canvas.height);
  }

  #lightOf(view: View, width: number, height: number): Pixels {
    const gl = this.#gl;
    if (!gl.getExtension("EXT_color_buffer_float")) throw new Failure("This device cannot draw in floating point.");
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
    const gl = this.#gl;
    const u = this.#uniforms;
    const isBeyond = this.#eye !== null;
    const hasDegrees = this.#hasDegrees;
    gl.viewport(0, 0, width, height);
    u.put("size", width, height);
    u.put("projection", PROJECTIONS.indexOf(view.projection));
    u.array("axes", cameraMatrix(view, this.#axes));
    u.put("half_field", Math.tan((view.field * RADIANS) / 2));
    this.#putLight("sun", view.sunAzimuth);
    this.#putLight("moon", view.moonAzimuth);
    u.put("is_beyond", Number(isBeyond));
    if (isBeyond) this.#putSpace(view);
    const isSplit = view.compare === "hosek" && this.#other !== null && !isBeyond;
    u.put("divider", isSplit ? view.divider / 100 : 2);
    if (isSplit) u.array("hosek", this.#other!);
    if (isSplit) u.array("hosek_sun", sunVector(view));
    u.put("quantity", hasDegrees ? QUANTITIES.indexOf(view.quantity) : 0);
    u.put("has_polariser", Number(hasDegrees && view.polariser !== null));
    u.put("polariser", (view.polariser ?? 0) * RADIANS);
    u.put("white", WHITE_AT_EV_0 * 2 ** this.exposure(view));
    u.put("tone", tone);
    u.put("is_daylight", Number(BALANCES[0] === view.balance));
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  #putLight(name: "sun" | "moon", azimuth: number): void {
    const u = this.#uniforms;
    const h = this.#tables.get(name)?.header ?? NONE;
    u.put(PLACES[name].horizon, h[0]!, h[1]!, h[2]!, h[3]!);
    u.put(PLACES[name].ends, h[4]!, h[5]!, h[6]!);
    u.put(PLACES[name].intervals, h[7]!, h[8]!, h[9]!);
    u.put(PLACES[name].azimuth, Math.cos(azimuth * RADIANS), Math.sin(azimuth * RADIANS));
  }

  #putSpace(view: View): void {
    const u = this.#uniforms;
    const h = this.#tables.get("space")?.header ?? NONE;
    u.put("eye", this.#eye ?? 1);
    u.array("space_sun", sunVector(view));
    u.put("space_ends", h[0]!, h[1]!, h[2]!, h[3]!);
    u.put("space_layers", h[4]!, h[5]!);
    u.put("space_counts", h[6]!, h[7]!, h[8]!, h[9]!);
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
    this.#uniforms = new Uniforms(gl, program);
    for (const [name, unit] of Object.entries(SAMPLERS)) this.#uniforms.put(name, unit);
    this.#textures.clear();
    for (const unit of Object.values(SAMPLERS)) this.#texture(unit, 1, 1, NONE.subarray(0, 4));
  }

  #texture(unit: number, width: number, height: number, values: Float32Array): void {
    const gl = this.#gl;
    gl.activeTexture(gl.TEXTURE0 + unit);
    if (!this.#textures.has(unit)) this.#textures.set(unit, gl.createTexture());
    gl.bindTexture(gl.TEXTURE_2D, this.#textures.get(unit)!);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, values);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }
}
