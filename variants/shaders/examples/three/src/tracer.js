/// Path tracer of hair on WebGPU: sums of samples by pixel, one more with each step.
import { buildTree } from './tree.js';
import { hitFunction } from './models.js';
import source from './paths.wgsl';
import { factorsOf, place } from './scattering.js';

export class Tracer {
  /// Needs WebGPU. Throws an error that says what is missing.
  static async start(strands) {
    const adapter = await navigator.gpu?.requestAdapter();
    if (!adapter) throw new Error('This browser has no WebGPU');
    const tracer = new Tracer();
    tracer.device = await adapter.requestDevice();
    const { STORAGE } = GPUBufferUsage,
      { boxes, segments } = buildTree(strands),
      tangents = new Float32Array((4 * strands.tangents.length) / 3);
    for (let at = 0; at < strands.tangents.length / 3; at++)
      tangents.set(strands.tangents.subarray(3 * at, 3 * at + 3), 4 * at);
    tracer.hair = [strands.nodes, tangents, segments, boxes].map(data => tracer.buffer(data, STORAGE));
    tracer.sample = 0;
    tracer.pipelines = {};
    return tracer;
  }

  buffer(data, usage) {
    const buffer = this.device.createBuffer({
      size: Math.max(16, data.byteLength),
      usage: usage | GPUBufferUsage.COPY_DST,
    });
    this.device.queue.writeBuffer(buffer, 0, data);
    return buffer;
  }

  /// Sets the material: the source of `eval_sample_hit` of its model, its constants, and the table of `scattering`, which conserves
  /// energy. Without a table the hair scatters as the model says.
  async setMaterial(text, constants, table) {
    const { call, type } = hitFunction(text, '_eval_sample_hit');
    this.pipelines[call] ??= this.device.createComputePipelineAsync({
      layout: 'auto',
      compute: {
        module: this.device.createShaderModule({
          code: text + place + source.replaceAll('CALL', call).replaceAll('MATERIAL', type),
        }),
        entryPoint: 'draw',
      },
    });
    const pipeline = await this.pipelines[call];
    this.material?.forEach(buffer => buffer.destroy());
    this.material = [constants, table ? factorsOf(table) : new Float32Array(8).fill(1)].map(data =>
      this.buffer(data, GPUBufferUsage.STORAGE),
    );
    this.pipeline = pipeline;
  }

  /// Sets the light, an `Environment`.
  setMap({ width, height, data }) {
    const texels = new Float32Array(4 * width * height),
      light = new Float64Array(width * height);
    let total = 0;
    for (let at = 0; at < light.length; at++) {
      const row = Math.floor(at / width),
        area = Math.cos((Math.PI * row) / height) - Math.cos((Math.PI * (row + 1)) / height);
      texels.set(data.subarray(3 * at, 3 * at + 3), 4 * at);
      light[at] = total += (data[3 * at] + data[3 * at + 1] + data[3 * at + 2]) * area;
    }
    light.forEach((sum, at) => (texels[4 * at + 3] = sum / total));
    this.map?.buffer.destroy();
    this.map = { buffer: this.buffer(texels, GPUBufferUsage.STORAGE), width, height };
  }

  /// Sets the view: a place, where it looks, and half its angle as a tangent. `side`: pixels along each side of the picture.
  setView({ eye, at, slope, backdrop = [0, 0, 0] }, side) {
    const minus = (a, b) => a.map((x, i) => x - b[i]),
      cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
      unit = a => a.map(x => x / Math.hypot(...a));
    const forward = unit(minus(at, eye)),
      right = unit(cross(forward, [0, 1, 0])),
      up = cross(right, forward);
    Object.assign(this, {
      side,
      view: { eye, right: right.map(x => x * slope), up: up.map(x => x * slope), forward, backdrop },
    });
  }

  /// Forgets all samples.
  restart() {
    this.picture?.destroy();
    this.picture = this.device.createBuffer({
      size: 16 * this.side ** 2,
      usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC,
    });
    this.steps = 0;
  }

  /// Adds samples to each pixel, and waits for them.
  async step(count = 1) {
    const { device, view, map, side } = this,
      groups = [];
    for (let i = 0; i < count; i++) {
      const floats = new Float32Array(20),
        ints = new Uint32Array(floats.buffer);
      [view.eye, view.right, view.up, view.forward, view.backdrop].forEach((vector, row) =>
        floats.set(vector, 4 * row),
      );
      [this.sample++, side, map.width, map.height].forEach((x, row) => (ints[4 * row + 3] = x));
      groups.push(this.buffer(floats, GPUBufferUsage.UNIFORM));
    }
    const encoder = device.createCommandEncoder();
    for (const scene of groups) {
      const pass = encoder.beginComputePass();
      pass.setPipeline(this.pipeline);
      pass.setBindGroup(
        0,
        device.createBindGroup({
          layout: this.pipeline.getBindGroupLayout(0),
          entries: [scene, ...this.hair, map.buffer, ...this.material, this.picture].map((buffer, binding) => ({
            binding,
            resource: { buffer },
          })),
        }),
      );
      pass.dispatchWorkgroups(Math.ceil(side ** 2 / 64));
      pass.end();
    }
    device.queue.submit([encoder.finish()]);
    await device.queue.onSubmittedWorkDone();
    groups.forEach(buffer => buffer.destroy());
    this.steps += count;
  }

  /// Sums of samples: red, green, blue and their number, for each pixel from the top left.
  async read() {
    const { device, picture } = this,
      read = device.createBuffer({ size: picture.size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST }),
      encoder = device.createCommandEncoder();
    encoder.copyBufferToBuffer(picture, 0, read, 0, picture.size);
    device.queue.submit([encoder.finish()]);
    await read.mapAsync(GPUMapMode.READ);
    const sums = new Float32Array(read.getMappedRange().slice(0));
    read.destroy();
    return sums;
  }
}
