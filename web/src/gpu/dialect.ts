// The shader for WebGL2 in the dialect of Vulkan, of which naga makes that for WebGPU: textures and uniforms are bound by
// number, and rows count from the top.

export interface Uniform {
  type: string;
  name: string;
  /** Vectors of four that it takes. */
  length: number;
}

const LINE = /^uniform (\w+) ([^;]+);.*$/gm;

/** What a shader wants, in its own order. */
export function uniforms(source: string): { textures: string[]; values: Uniform[] } {
  const all = [...source.matchAll(LINE)].flatMap(([, type, names]) => names!.split(",").map((name) => [type!, name.trim()] as const));
  const values = all
    .filter(([type]) => type !== "sampler2D")
    .map(([type, name]) => {
      const array = /^(\w+)\[(\d+)\]$/.exec(name);
      return { type, name: array?.[1] ?? name, length: array ? Number(array[2]) : type === "mat3" ? 3 : 1 };
    });
  return { textures: all.filter(([type]) => type === "sampler2D").map(([, name]) => name), values };
}

const SWIZZLE: Record<string, string> = { vec2: ".xy", vec3: ".xyz", vec4: "", float: ".x", int: ".x", bool: ".x" };

function assignment({ type, name, length }: Uniform, at: number): string {
  const value = (i: number) => `values[${at + i}]`;
  if (type === "mat3") return `${name} = mat3(${value(0)}.xyz, ${value(1)}.xyz, ${value(2)}.xyz);`;
  if (type === "vec4" && length > 1) return Array.from({ length }, (_, i) => `${name}[${i}] = ${value(i)};`).join(" ");
  if (type === "int") return `${name} = int(${value(0)}.x);`;
  if (type === "ivec3") return `${name} = ivec3(${value(0)}.xyz);`;
  if (type === "bool") return `${name} = ${value(0)}.x != 0.0;`;
  return `${name} = ${value(0)}${SWIZZLE[type]};`;
}

export function vulkan(source: string): string {
  const { textures, values } = uniforms(source);
  const total = values.reduce((sum, { length }) => sum + length, 0);
  let at = 0;
  const assignments = values.map((uniform) => {
    const text = assignment(uniform, at);
    at += uniform.length;
    return `  ${text}`;
  });
  const head = [
    "#version 450",
    `layout(set = 0, binding = 0) uniform Values { vec4 values[${total}]; };`,
    ...textures.map((name, i) => `layout(set = 0, binding = ${i + 1}) uniform texture2D ${name};`),
    "layout(location = 0) out vec4 colour;",
    "vec4 place_in_picture;",
    ...values.map(({ type, name, length }) => `${type} ${name}${type === "vec4" && length > 1 ? `[${length}]` : ""};`),
  ];
  const body = source
    .replace(LINE, "")
    .replace(/^#version.*$|^precision.*$|^out vec4 colour;$/gm, "")
    .replaceAll("gl_FragCoord", "place_in_picture")
    .replace(
      /void main\(\) \{/,
      `void main() {\n${assignments.join("\n")}\n  place_in_picture = vec4(gl_FragCoord.x, size.y - gl_FragCoord.y, 0.0, 1.0);`,
    );
  return [...head, body].join("\n");
}
