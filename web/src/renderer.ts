// Draws the sky with WebGL2.

import { aspect, cameraMatrix } from "./directions";
import { Failure } from "./failure";
import type { SkyTables } from "./protocol";
import { FRAGMENT, VERTEX } from "./shader";
import { Uniforms } from "./uniforms";
import { BALANCES, PROJECTIONS, QUANTITIES, TONES, type View } from "./view";

const RADIANS = Math.PI / 180;
/** Luminance of scene white at exposure value 0 (ISO 100), cd m⁻², and what a sky's mean is of white. */
const WHITE_AT_EV_0 = 1.2;
const SKY = 0.36;

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
  #textures: WebGLTexture[] = [];
  #tables: SkyTables | null = null;
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
      if (this.#tables) this.upload(this.#tables);
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
    this.#tables = tables;
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
    const u = this.#uniforms;
    const h = tables.header;
    const hasDegrees = tables.degrees !== null;
    gl.viewport(0, 0, width, height);
    u.put("size", width, height);
    u.put("projection", PROJECTIONS.indexOf(view.projection));
    u.array("axes", cameraMatrix(view, this.#axes));
    u.put("half_field", Math.tan((view.field * RADIANS) / 2));
    u.put("horizon", h[0]!, h[1]!, h[2]!, h[3]!);
    u.put("ends", h[4]!, h[5]!, h[6]!);
    u.put("intervals", h[7]!, h[8]!, h[9]!);
    u.put("sun", Math.cos(view.sunAzimuth * RADIANS), Math.sin(view.sunAzimuth * RADIANS));
    u.put("quantity", hasDegrees ? QUANTITIES.indexOf(view.quantity) : 0);
    u.put("has_polariser", Number(hasDegrees && view.polariser !== null));
    u.put("polariser", (view.polariser ?? 0) * RADIANS);
    u.put("white", WHITE_AT_EV_0 * 2 ** this.exposure(view));
    u.put("tone", tone);
    u.put("is_daylight", Number(BALANCES[0] === view.balance));
    gl.drawArrays(gl.TRIANGLES, 0, 3);
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
    this.#uniforms.put("roots", 0);
    this.#uniforms.put("degrees", 1);
    this.#textures = [gl.createTexture(), gl.createTexture()];
    const nothing = new Float32Array(4);
    for (const unit of [0, 1]) this.#texture(unit, 1, 1, nothing);
  }

  #texture(unit: number, width: number, height: number, values: Float32Array): void {
    const gl = this.#gl;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, this.#textures[unit]!);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, values);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }
}
