// Runs a compute shader of one input and one output buffer on WebGPU, in headless Chromium on SwiftShader.
//
//   node webgpu.mjs MODULE.wgsl ENTRY INPUT OUTPUT FLOATS_PER_CALL FLOATS_PER_RESULT
//
// $HAIRIS_CHROMIUM is the browser, and $HAIRIS_PLAYWRIGHT the folder in which playwright-core is installed.
import { readFileSync, statSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';

const { HAIRIS_CHROMIUM: executablePath, HAIRIS_PLAYWRIGHT: folder } = process.env;
const { chromium } = createRequire(`${folder}/`)('playwright-core');
const [module, entry, input, output, perCall, perResult] = process.argv.slice(2);
const files = { '/module': module, '/input': input };
const server = createServer(async (request, answer) => {
  if (request.method === 'POST') writeFileSync(output, Buffer.concat(await request.toArray()));
  answer.writeHead(200, { 'content-type': 'text/html' });
  answer.end(files[request.url] ? readFileSync(files[request.url]) : '');
});
await new Promise(ready => server.listen(0, '127.0.0.1', ready));
const browser = await chromium.launch({
  executablePath,
  args: ['--no-sandbox', '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan'],
});

/// Runs in the browser: sets up the pipeline, dispatches once, and posts the results to the server.
async function run({ entry, calls, size }) {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) throw new Error('no adapter of WebGPU');
  const device = await adapter.requestDevice();
  const module = device.createShaderModule({ code: await (await fetch('/module')).text() });
  const { messages } = await module.getCompilationInfo();
  if (messages.length) throw new Error(messages.map(({ lineNum, message }) => `${lineNum}: ${message}`).join('\n'));
  const pipeline = await device.createComputePipelineAsync({ layout: 'auto', compute: { module, entryPoint: entry } });
  const input = await (await fetch('/input')).arrayBuffer();
  const { STORAGE, COPY_SRC, COPY_DST, MAP_READ } = GPUBufferUsage;
  const from = device.createBuffer({ size: input.byteLength, usage: STORAGE | COPY_DST });
  const to = device.createBuffer({ size, usage: STORAGE | COPY_SRC });
  const read = device.createBuffer({ size, usage: MAP_READ | COPY_DST });
  device.queue.writeBuffer(from, 0, input);
  const encoder = device.createCommandEncoder(),
    pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(
    0,
    device.createBindGroup({
      layout: pipeline.getBindGroupLayout(0),
      entries: [from, to].map((buffer, binding) => ({ binding, resource: { buffer } })),
    }),
  );
  pass.dispatchWorkgroups(Math.ceil(calls / 64));
  pass.end();
  encoder.copyBufferToBuffer(to, 0, read, 0, size);
  device.queue.submit([encoder.finish()]);
  await read.mapAsync(GPUMapMode.READ);
  await fetch('/output', { method: 'POST', body: read.getMappedRange().slice() });
}

try {
  const page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  const calls = statSync(input).size / 4 / perCall;
  await page.evaluate(run, { entry, calls, size: 4 * calls * perResult });
} finally {
  await browser.close();
  server.close();
}
