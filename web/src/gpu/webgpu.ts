// Draws with WebGPU: the same shader, translated to `sky.wgsl`.

import { channelsOf, type Texels, type Textures, type Values } from "../inputs";
import { FRAGMENT } from "../shader";
import type { Device } from "./device";
import { uniforms } from "./dialect";

const WANTED = uniforms(FRAGMENT);
const VECTORS = WANTED.values.reduce((sum, { length }) => sum + length, 0);
const LIGHT = "rgba32float";
const FORMATS: Record<number, GPUTextureFormat> = { 1: "r32float", 2: "rg32float", 4: "rgba32float" };
const CORNERS = `@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
  return vec4f(select(-1.0, 3.0, i == 1u), select(-1.0, 3.0, i == 2u), 0.0, 1.0);
}`;

export class WebGPU implements Device {
  readonly name = "webgpu";
  readonly #textures = new Map<string, GPUTexture>();
  readonly #buffer: GPUBuffer;
  #group: GPUBindGroup | null = null;

  private constructor(
    private readonly device: GPUDevice,
    private readonly context: GPUCanvasContext,
    private readonly layout: GPUBindGroupLayout,
    private readonly pipelines: Record<"canvas" | "light", GPURenderPipeline>,
  ) {
    const usage = GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST;
    this.#buffer = device.createBuffer({ size: 16 * VECTORS, usage });
    const nothing = { width: 1, height: 1, values: new Float32Array(4) };
    this.upload(Object.fromEntries(WANTED.textures.map((name) => [name, nothing])));
  }

  /** Null where the browser has no such device, or its shader cannot be fetched or does not run. The canvas is not touched
   * before all is well. */
  static async create(canvas: HTMLCanvasElement, shader: string, onLost: () => void): Promise<WebGPU | null> {
    const adapter = await navigator.gpu?.requestAdapter().catch(() => null);
    if (!adapter || adapter.limits.maxSampledTexturesPerShaderStage < WANTED.textures.length) return null;
    const [device, response] = await Promise.all([adapter.requestDevice().catch(() => null), fetch(shader).catch(() => null)]);
    if (!device || !response?.ok) return null;
    const format = navigator.gpu.getPreferredCanvasFormat();
    const made = await pipelines(device, await response.text(), format).catch(() => null);
    const context = made && canvas.getContext("webgpu");
    if (!context) return null;
    context.configure({ device, format, alphaMode: "opaque" });
    void device.lost.then(onLost);
    return new WebGPU(device, context, made.layout, made);
  }

  upload(textures: Textures): void {
    for (const [name, texels] of Object.entries(textures)) {
      this.#textures.get(name)?.destroy();
      this.#textures.set(name, this.#texture(texels));
    }
    this.#group = null;
  }

  #texture(texels: Texels): GPUTexture {
    const channels = channelsOf(texels);
    const size = [texels.width, texels.height];
    const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST;
    const texture = this.device.createTexture({ size, format: FORMATS[channels]!, usage });
    const values = texels.values as Float32Array<ArrayBuffer>;
    this.device.queue.writeTexture({ texture }, values, { bytesPerRow: 4 * channels * texels.width }, size);
    return texture;
  }

  draw(values: Values): void {
    this.#paint(values, this.pipelines.canvas, this.context.getCurrentTexture());
  }

  async read(values: Values, width: number, height: number): Promise<Float32Array> {
    const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC;
    const target = this.device.createTexture({ size: [width, height], format: LIGHT, usage });
    this.#paint(values, this.pipelines.light, target);
    // Rows of copies are whole multiples of 256 bytes.
    const row = Math.ceil((16 * width) / 256) * 256;
    const copy = this.device.createBuffer({ size: row * height, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    const encoder = this.device.createCommandEncoder();
    encoder.copyTextureToBuffer({ texture: target }, { buffer: copy, bytesPerRow: row }, [width, height]);
    this.device.queue.submit([encoder.finish()]);
    await copy.mapAsync(GPUMapMode.READ);
    const floats = new Float32Array(copy.getMappedRange());
    const light = new Float32Array(4 * width * height);
    for (let y = 0; y < height; y++) {
      light.set(floats.subarray((y * row) / 4, (y * row) / 4 + 4 * width), 4 * width * (height - 1 - y));
    }
    copy.destroy();
    target.destroy();
    return light;
  }

  #paint(values: Values, pipeline: GPURenderPipeline, target: GPUTexture): void {
    this.device.queue.writeBuffer(this.#buffer, 0, packed(values));
    const encoder = this.device.createCommandEncoder();
    const attachment = { view: target.createView(), loadOp: "clear", storeOp: "store" } as const;
    const pass = encoder.beginRenderPass({ colorAttachments: [attachment] });
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, (this.#group ??= this.#bind()));
    pass.draw(3);
    pass.end();
    this.device.queue.submit([encoder.finish()]);
  }

  #bind(): GPUBindGroup {
    const entries: GPUBindGroupEntry[] = [{ binding: 0, resource: { buffer: this.#buffer } }];
    WANTED.textures.forEach((name, i) => entries.push({ binding: i + 1, resource: this.#textures.get(name)!.createView() }));
    return this.device.createBindGroup({ layout: this.layout, entries });
  }
}

/** Values in vectors of four, as `dialect.ts` takes them out. */
function packed(values: Values): Float32Array<ArrayBuffer> {
  const out = new Float32Array(4 * VECTORS);
  let at = 0;
  for (const { type, name, length } of WANTED.values) {
    const value = values[name]!;
    const width = type === "mat3" ? 3 : 4;
    for (let i = 0; i < length; i++) out.set(value.slice(width * i, width * (i + 1)), at + 4 * i);
    at += 4 * length;
  }
  return out;
}

async function pipelines(device: GPUDevice, shader: string, format: GPUTextureFormat) {
  const texture: GPUTextureBindingLayout = { sampleType: "unfilterable-float" };
  const entries: GPUBindGroupLayoutEntry[] = [{ binding: 0, visibility: GPUShaderStage.FRAGMENT, buffer: {} }];
  WANTED.textures.forEach((_, i) => entries.push({ binding: i + 1, visibility: GPUShaderStage.FRAGMENT, texture }));
  const group = device.createBindGroupLayout({ entries });
  const layout = device.createPipelineLayout({ bindGroupLayouts: [group] });
  const vertex = { module: device.createShaderModule({ code: CORNERS }) };
  const module = device.createShaderModule({ code: shader });
  const pipeline = (format: GPUTextureFormat) =>
    device.createRenderPipelineAsync({ layout, vertex, fragment: { module, targets: [{ format }] } });
  const [canvas, light] = await Promise.all([pipeline(format), pipeline(LIGHT)]);
  return { layout: group, canvas, light };
}
