// Uniforms of a program, set only where they change: a call to the driver costs more than a comparison.

type Set = (gl: WebGL2RenderingContext, at: WebGLUniformLocation | null, v: Float32Array) => void;

const FLOATS: Record<number, Set> = {
  1: (gl, at, v) => gl.uniform1fv(at, v),
  2: (gl, at, v) => gl.uniform2fv(at, v),
  3: (gl, at, v) => gl.uniform3fv(at, v),
  4: (gl, at, v) => gl.uniform4fv(at, v),
  9: (gl, at, v) => gl.uniformMatrix3fv(at, false, v),
};
const INTEGERS: Record<number, Set> = {
  1: (gl, at, v) => gl.uniform1i(at, v[0]!),
  3: (gl, at, v) => gl.uniform3i(at, v[0]!, v[1]!, v[2]!),
  4: (gl, at, v) => gl.uniform4i(at, v[0]!, v[1]!, v[2]!, v[3]!),
};

class Uniform {
  readonly #at: WebGLUniformLocation | null;
  readonly #last: Float32Array;
  readonly #set: Set;

  constructor(gl: WebGL2RenderingContext, program: WebGLProgram, { name, type, size }: WebGLActiveInfo) {
    const integers: number[] = [gl.INT, gl.INT_VEC3, gl.INT_VEC4, gl.BOOL, gl.SAMPLER_2D];
    const parts = new Map<number, number>([
      [gl.FLOAT_VEC2, 2], [gl.FLOAT_VEC3, 3], [gl.FLOAT_VEC4, 4], [gl.FLOAT_MAT3, 9], [gl.INT_VEC3, 3], [gl.INT_VEC4, 4],
    ]);
    const count = parts.get(type) ?? 1;
    this.#at = gl.getUniformLocation(program, name);
    this.#last = new Float32Array(count * size).fill(NaN);
    this.#set = (integers.includes(type) ? INTEGERS : FLOATS)[count]!;
  }

  put(gl: WebGL2RenderingContext, values: ArrayLike<number>): void {
    const last = this.#last;
    let isSame = true;
    for (let i = 0; i < last.length; i++) {
      const value = Math.fround(values[i]!);
      if (last[i] === value) continue;
      last[i] = value;
      isSame = false;
    }
    if (!isSame) this.#set(gl, this.#at, last);
  }
}

/** Of the program in use; names that the compiler left out are passed over. */
export class Uniforms {
  readonly #all = new Map<string, Uniform>();
  readonly #four = new Float32Array(4);

  constructor(
    private readonly gl: WebGL2RenderingContext,
    program: WebGLProgram,
  ) {
    const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) as number;
    for (let i = 0; i < count; i++) {
      const info = gl.getActiveUniform(program, i);
      if (info) this.#all.set(info.name.replace(/\[0\]$/, ""), new Uniform(gl, program, info));
    }
  }

  array(name: string, values: ArrayLike<number>): void {
    this.#all.get(name)?.put(this.gl, values);
  }

  /** Up to four numbers. */
  put(name: string, a: number, b = 0, c = 0, d = 0): void {
    const four = this.#four;
    four[0] = a;
    four[1] = b;
    four[2] = c;
    four[3] = d;
    this.#all.get(name)?.put(this.gl, four);
  }
}
