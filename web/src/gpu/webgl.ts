// Draws with WebGL2.

import { Failure } from "../failure";
import { channelsOf, type Texels, type Textures, type Values } from "../inputs";
import { FRAGMENT, VERTEX } from "../shader";
import type { Device } from "./device";
import { type Uniform, uniforms } from "./dialect";

const WANTED = uniforms(FRAGMENT);

export class WebGL implements Device {
  readonly name = "webgl";
  readonly #gl: WebGL2RenderingContext;
  #places = new Map<string, WebGLUniformLocation | null>();
  /** What the uniforms are: to set one costs more than to compare it. */
  #last = new Map<string, Float32Array>();
  #textures: WebGLTexture[] = [];
  #texels: Textures = {};

  constructor(canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: false, depth: false, preserveDrawingBuffer: true });
    if (!gl) throw new Failure("This browser does not give the page WebGL2, with which the sky is drawn.");
    this.#gl = gl;
    this.#build();
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => {
      this.#build();
      this.upload(this.#texels);
      canvas.dispatchEvent(new Event("redraw"));
    });
  }

  upload(textures: Textures): void {
    this.#texels = { ...this.#texels, ...textures };
    for (const [name, texels] of Object.entries(textures)) this.#texture(WANTED.textures.indexOf(name), texels);
  }

  draw(values: Values, width: number, height: number): void {
    this.#gl.bindFramebuffer(this.#gl.FRAMEBUFFER, null);
    this.#paint(values, width, height);
  }

  async read(values: Values, width: number, height: number): Promise<Float32Array> {
    const gl = this.#gl;
    if (!gl.getExtension("EXT_color_buffer_float")) throw new Failure("This device cannot draw in floating point.");
    const [target, buffer] = [gl.createTexture(), gl.createFramebuffer()];
    gl.activeTexture(gl.TEXTURE0 + WANTED.textures.length);
    gl.bindTexture(gl.TEXTURE_2D, target);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
    const light = new Float32Array(4 * width * height);
    this.#paint(values, width, height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, light);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(buffer);
    gl.deleteTexture(target);
    return light;
  }

  #paint(values: Values, width: number, height: number): void {
    this.#gl.viewport(0, 0, width, height);
    for (const uniform of WANTED.values) {
      const value = values[uniform.name]!;
      if (this.#isNew(uniform.name, value)) this.#set(uniform, value);
    }
    this.#gl.drawArrays(this.#gl.TRIANGLES, 0, 3);
  }

  #isNew(name: string, value: Values[string]): boolean {
    const last = this.#last.get(name);
    if (last && last.every((number, i) => number === Math.fround(value[i]!))) return false;
    this.#last.set(name, Float32Array.from(value));
    return true;
  }

  #set({ type, name }: Uniform, value: Values[string]): void {
    const [gl, at] = [this.#gl, this.#places.get(name)!];
    if (type === "int" || type === "bool") gl.uniform1iv(at, value as number[]);
    else if (type === "ivec3") gl.uniform3iv(at, value as number[]);
    else if (type === "float") gl.uniform1fv(at, value);
    else if (type === "vec2") gl.uniform2fv(at, value);
    else if (type === "vec3") gl.uniform3fv(at, value);
    else if (type === "vec4") gl.uniform4fv(at, value);
    else gl.uniformMatrix3fv(at, false, value);
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
    this.#last.clear();
    this.#places = new Map(WANTED.values.map(({ name }) => [name, gl.getUniformLocation(program, name)]));
    this.#textures = WANTED.textures.map(() => gl.createTexture());
    WANTED.textures.forEach((name, unit) => {
      gl.uniform1i(gl.getUniformLocation(program, name), unit);
      this.#texture(unit, { width: 1, height: 1, values: new Float32Array(4) });
    });
  }

  #texture(unit: number, texels: Texels): void {
    const gl = this.#gl;
    const { width, height, values } = texels;
    const channels = channelsOf(texels);
    const [inner, format] =
      channels === 1 ? [gl.R32F, gl.RED] : channels === 2 ? [gl.RG32F, gl.RG] : ([gl.RGBA32F, gl.RGBA] as const);
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, this.#textures[unit]!);
    gl.texImage2D(gl.TEXTURE_2D, 0, inner, width, height, 0, format, gl.FLOAT, values);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }
}
