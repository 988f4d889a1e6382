// The generated WGSL on WebGPU: light towards the viewer from hits under a few directions.

class Gpu {
  static async start() {
    if (!navigator.gpu) throw new Error('This browser has no WebGPU, so that the module shades');
    const adapter = await navigator.gpu.requestAdapter();
    if (!adapter) throw new Error('WebGPU found no adapter, so that the module shades');
    const gpu = new Gpu();
    gpu.device = await adapter.requestDevice();
    gpu.device.lost.then(({ message }) => {
      tuft.gpu = null;
      tuft.isGpu = false;
      tellTuft(`WebGPU was lost: ${message}`);
    });
    gpu.pipelines = {};
    gpu.slots = [null, null];
    if (!(await gpu.prepare())) throw new Error('there is no shader of a model beside the page');
    return gpu;
  }

  /// The pipeline of a model, compiled once.
  pipeline(model) {
    return (this.pipelines[model] ??= (async () => {
      const response = await fetch(`${model}.wgsl`);
      if (!response.ok) throw new Error(`there is no ${model}.wgsl beside the page`);
      const source = await response.text(),
        name = source.match(/fn (hairis_\w+_eval_hit\w*)\(material: (\w+)/);
      this.device.pushErrorScope('validation');
      const module = this.device.createShaderModule({ code: `${source}\n${shader(name[1], name[2])}` });
      const pipeline = await this.device.createComputePipelineAsync({
        layout: 'auto',
        compute: { module, entryPoint: 'main' },
      });
      const error = await this.device.popErrorScope();
      if (error) throw new Error(error.message);
      return pipeline;
    })());
  }

  /// Pipelines and constants of the state's materials.
  async prepare() {
    const names = state.materials.map(({ model }) => model);
    const constants = [0, 1].map(slot => kernel.work[0].slice(0, kernel.calls.constants(slot)));
    const pipelines = await Promise.all(names.map(name => this.pipeline(name)));
    this.slots.forEach(slot => slot?.constants.destroy());
    this.slots = pipelines.map((pipeline, slot) => ({
      pipeline,
      constants: this.buffer(constants[slot], GPUBufferUsage.STORAGE),
    }));
    return true;
  }

  buffer(data, usage) {
    const buffer = this.device.createBuffer({
      size: Math.max(16, (data.byteLength + 15) & ~15),
      usage: usage | GPUBufferUsage.COPY_DST,
    });
    this.device.queue.writeBuffer(buffer, 0, data);
    return buffer;
  }

  async shade(slot, { count, lights, seen, hits, wo }) {
    const { device } = this,
      { pipeline, constants } = this.slots[slot],
      size = Math.max(16, 16 * count);
    const scene = new Float32Array(4 + 8 * DIRECTIONS);
    scene.set([...wo, 0]);
    lights.forEach(({ dir, radiance }, i) =>
      scene.set([...dir, 0, ...radiance.map(x => x / DIRECTIONS), 0], 4 + 8 * i),
    );
    const inputs = [hits, seen, scene].map(data => this.buffer(data, GPUBufferUsage.STORAGE));
    const out = device.createBuffer({ size, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC }),
      read = device.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    const group = device.createBindGroup({
      layout: pipeline.getBindGroupLayout(0),
      entries: [...inputs, constants, out].map((buffer, binding) => ({ binding, resource: { buffer } })),
    });
    const encoder = device.createCommandEncoder(),
      pass = encoder.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, group);
    pass.dispatchWorkgroups(Math.ceil(count / 64));
    pass.end();
    encoder.copyBufferToBuffer(out, 0, read, 0, size);
    device.queue.submit([encoder.finish()]);
    await read.mapAsync(GPUMapMode.READ);
    const result = new Float32Array(read.getMappedRange().slice(0, 16 * count));
    for (const buffer of [...inputs, out, read]) buffer.destroy();
    return result;
  }
}

const shader = (call, material) => `
struct Light { dir: vec4f, radiance: vec4f }
struct Scene { wo: vec4f, lights: array<Light, ${DIRECTIONS}> }
@group(0) @binding(0) var<storage, read> hits: array<vec4f>;
@group(0) @binding(1) var<storage, read> seen: array<vec4f>;
@group(0) @binding(2) var<storage, read> scene: Scene;
@group(0) @binding(3) var<storage, read> constants: ${material};
@group(0) @binding(4) var<storage, read_write> result: array<vec4f>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
  if (id.x >= arrayLength(&hits)) { return; }
  let hit = hits[id.x];
  let u = hit.xyz;
  let along = dot(scene.wo.xyz, u);
  let cosine = sqrt(max(1e-12, 1.0 - along * along));
  let v = (scene.wo.xyz - along * u) / cosine;
  let w = cross(u, v);
  var sum = vec3f();
  for (var i = 0; i < ${DIRECTIONS}; i++) {
    let light = scene.lights[i];
    let wi = vec3f(dot(light.dir.xyz, u), dot(light.dir.xyz, v), dot(light.dir.xyz, w));
    let value = ${call}(constants, vec3f(along, cosine, 0.0), hit.w, wi);
    sum += value.value * light.radiance.xyz * seen[id.x][i] * length(wi.yz);
  }
  result[id.x] = vec4f(sum, 0.0);
}`;
