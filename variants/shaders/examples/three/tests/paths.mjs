// Tests against hairis-render, on hair, maps and a camera that both have: the path tracer in the browser, and direct light of three.js.
import { execFile } from 'node:child_process';
import { readFileSync, rmSync, writeFileSync } from 'node:fs';
import { mkdtemp } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { promisify } from 'node:util';
import { exr } from './maps.mjs';

const SIDE = 48,
  NODES = 5,
  SPP = 128;

/// A tuft of bent strands: x, y, z and radius of each node.
function tuft(count, radius) {
  let seed = 5;
  const random = () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;
  return Array.from({ length: count }, () => {
    const [x, z, a, b] = [random() - 0.5, random() - 0.5, random() - 0.5, random() - 0.5];
    return Array.from({ length: NODES }, (_, i) => {
      const t = i / (NODES - 1);
      return [2.4 * x + 1.6 * a * t * t, 3 * t, 2.4 * z + 1.6 * b * t * t, radius * (1 - 0.5 * t)].map(Math.fround);
    });
  }).flat();
}

/// The hair as cyHair.
function hairFile(nodes) {
  const head = Buffer.alloc(128);
  head.write('HAIR');
  [nodes.length / NODES, nodes.length, 2 | 4, NODES - 1].forEach((x, i) => head.writeUInt32LE(x, 4 + 4 * i));
  return Buffer.concat([
    head,
    Buffer.from(Float32Array.from(nodes.flatMap(node => node.slice(0, 3))).buffer),
    Buffer.from(Float32Array.from(nodes, node => 2 * node[3]).buffer),
  ]);
}

/// A dim map of 32 by 16, bluer to the left, with a lamp high on the left and a redder one low behind. Half 0x4900 is 10, 0x4500 is 5.
const map = exr(false, (i, row) => {
  const [channel, column] = [Math.floor(i / 32), i % 32];
  if (row > 2 && row < 6 && column > 8 && column < 13) return 0x4900;
  if (row > 8 && row < 12 && column < 3) return channel === 2 ? 0x4900 : 0x4500;
  return column < 16 === (channel === 0) ? 0x3400 : 0x2e66;
});

/// A picture of hairis-render, of hair and a map of light in files, as base64.
async function rendered(render, hair, map, flags) {
  const out = map.replace('.exr', '-seen.exr');
  const scene = ['env', '--curve', 'linear', '--backdrop', '0', '--import', hair, '--env', map];
  await promisify(execFile)(render, ['render', ...scene, ...flags.split(' '), '--out', out]);
  const bytes = readFileSync(out).toString('base64');
  // Otherwise the next picture would go on from this one.
  for (const kind of ['exr', 'png', 'part']) rmSync(out.replace(/exr$/, kind), { force: true });
  return bytes;
}

/// In the browser: makes the function `framed`, which returns strands of nodes with the camera of hairis-render for hair from a file.
function addFramed() {
  globalThis.framed = (nodes, count) => {
    const strands = new globalThis.hairis.Strands(
        Float32Array.from(nodes.flat()),
        Uint32Array.from({ length: nodes.length / count }, (_, i) => count * (i + 1)),
      ),
      { low, high } = strands.box,
      centre = low.map((x, axis) => (x + high[axis]) / 2),
      scale = Math.hypot(...low.map((x, axis) => high[axis] - x)) / 40;
    return { strands, centre, eye: [centre[0], centre[1] + 9 * scale, centre[2] + 52 * scale] };
  };
}

/// The means of the pictures agree within their errors, for a model of the near field and one of the far field.
export async function paths({ open, check, render }) {
  const folder = await mkdtemp(join(tmpdir(), 'hairis-')),
    nodes = tuft(160, 0.06),
    page = await open('three/paths.html?every=500&side=16&model=kajiya-kay', { width: 800, height: 800 });
  writeFileSync(join(folder, 'tuft.hair'), hairFile(nodes));
  writeFileSync(join(folder, 'map.exr'), map);
  await page.waitForFunction(
    () => globalThis.hairis?.steps > 4 || document.getElementById('refusal').textContent,
    null,
    { timeout: 60_000 },
  );
  await page.evaluate(addFramed);
  check(
    'the path tracer starts',
    (await page.locator('#refusal').textContent()) === '',
    await page.locator('#refusal').textContent(),
  );
  for (const [model, preset] of [
    ['chiang', 'default'],
    ['gaussian', 'brown'],
  ]) {
    const picture = await rendered(
      render,
      join(folder, 'tuft.hair'),
      join(folder, 'map.exr'),
      `--integrator path --model ${model} --hair ${preset} --spp ${16 * SPP} --size ${SIDE}x${SIDE}`,
    );
    const { truth, sums } = await page.evaluate(
      async ({ nodes, NODES, SIDE, model, preset, SPP, map, picture }) => {
        const { Tracer, models, readLight } = hairis,
          file = (name, bytes) => new File([Uint8Array.from(atob(bytes), letter => letter.charCodeAt(0))], name),
          { strands, centre, eye } = framed(nodes, NODES);
        const tracer = await Tracer.start(strands),
          { kernel } = models;
        const refusal = kernel.setMaterial(0, { model, values: models.presets(model)[preset] });
        if (refusal) throw new Error(refusal);
        await tracer.setMaterial(
          await models.source(model, '.paths.wgsl'),
          kernel.work[0].slice(0, kernel.calls.constants(0)),
        );
        tracer.setMap(await readLight(file('map.exr', map)));
        tracer.setView({ eye, at: centre, slope: Math.tan((21 * Math.PI) / 180) }, SIDE);
        const sums = [];
        for (let batch = 0; batch < 8; batch++) {
          tracer.restart();
          for (let i = 0; i < SPP / 8; i++) await tracer.step();
          sums.push(Array.from(await tracer.read()));
        }
        return { truth: Array.from((await readLight(file('picture.exr', picture))).data), sums };
      },
      {
        nodes,
        NODES,
        SIDE,
        model,
        preset,
        SPP,
        map: map.toString('base64'),
        picture,
      },
    );
    // Means of the picture and of its quarters, by channel.
    let [worst, most] = [0, 0];
    const quarters = [
      () => true,
      ...[0, 1, 2, 3].map(quarter => pixel => (pixel % SIDE < SIDE / 2) + 2 * (pixel < (SIDE * SIDE) / 2) === quarter),
    ];
    quarters.forEach((isIn, part) => {
      for (let c = 0; c < 3; c++) {
        const mean = value => {
          let [total, count] = [0, 0];
          for (let pixel = 0; pixel < SIDE * SIDE; pixel++)
            if (isIn(pixel)) [total, count] = [total + value(pixel), count + 1];
          return total / count;
        };
        const batches = sums.map(picture => mean(pixel => picture[4 * pixel + c] / picture[4 * pixel + 3])),
          own = batches.reduce((a, b) => a + b) / batches.length,
          error = Math.sqrt(batches.reduce((a, b) => a + (b - own) ** 2, 0) / (batches.length * (batches.length - 1))),
          expected = mean(pixel => truth[3 * pixel + c]),
          // hairis-render has 16 times as many samples.
          distance = Math.abs(own - expected) / (error * Math.sqrt(1 + 1 / 16));
        if (!part) most = Math.max(most, Math.abs(own / expected - 1));
        worst = Math.max(worst, distance);
        check(
          'paths have the mean of hairis-render',
          own > 0 && error < 0.05 * own && distance < 6,
          `${model}, part ${part}, channel ${c}: ${own} ± ${error} and ${expected}`,
        );
      }
    });
    console.log(
      `paths of ${model}: the mean is that of hairis-render to ${(100 * most).toFixed(2)}%, and means of quarters are ${worst.toFixed(1)} standard errors off at most`,
    );
  }
  await page.close();
}

/// A map of 256 by 128 with one bright texel, which stands for a directional light.
const SUN_ROW = 40,
  sun = column => exr(false, (i, row) => (row === SUN_ROW && i % 256 === column ? 0x7000 : 0), [256, 128]);

/// Light of hair in its own shadow: means of the picture, with crossings of the volume and of rays, once scattered and by dual scattering.
export async function direct({ open, check, render }) {
  const folder = await mkdtemp(join(tmpdir(), 'hairis-')),
    nodes = tuft(600, 0.02),
    SIDE = 128,
    page = await open('three/?every=500&model=kajiya-kay', { width: 480, height: 480 }),
    [hair, map] = ['tuft.hair', 'sun.exr'].map(name => join(folder, name));
  await page.waitForFunction(() => globalThis.hairis?.frames > 0, null, { timeout: 60_000 });
  await page.evaluate(addFramed);
  writeFileSync(hair, hairFile(nodes));
  // Light from behind the hair, and from before it.
  for (const [model, column] of [
    ['kajiya-kay', 150],
    ['chiang', 20],
  ]) {
    writeFileSync(map, sun(column));
    const pictures = [];
    for (const integrator of ['direct', 'dual'])
      pictures.push(
        await rendered(
          render,
          hair,
          map,
          `--integrator ${integrator} --model ${model} --hair brown --spp 256 --size ${SIDE}x${SIDE}`,
        ),
      );
    const { truth, seen } = await page.evaluate(
      async ({ nodes, NODES, SIDE, model, pictures, sun: [column, row] }) => {
        const { THREE, Crossings, library, renderer, ribbons, readLight } = hairis,
          { strands, centre, eye } = framed(nodes, NODES);
        const edge = at => Math.cos((Math.PI * at) / 128),
          y = (edge(row) + edge(row + 1)) / 2,
          turn = 2 * Math.PI * ((column + 0.5) / 256 - 0.5),
          solid = ((edge(row) - edge(row + 1)) * 2 * Math.PI) / 256,
          light = new THREE.DirectionalLight(0xffffff, 8192 * solid),
          camera = new THREE.PerspectiveCamera(42, 1, 0.1, 100),
          target = new THREE.RenderTarget(SIDE, SIDE, { type: THREE.FloatType });
        light.position
          .set(Math.sqrt(1 - y * y) * Math.sin(turn), y, -Math.sqrt(1 - y * y) * Math.cos(turn))
          .multiplyScalar(100);
        camera.position.set(...eye);
        camera.lookAt(...centre);
        const meanOf = (data, width, count) =>
            [0, 1, 2].map(c => data.reduce((sum, x, at) => (at % width === c ? sum + x : sum), 0) / count),
          seen = [],
          truth = [];
        // Once scattered, all, and once scattered without shadow.
        for (const [crossings, gain] of [
          [new Crossings(strands), 0],
          [new Crossings(strands), 1.15],
          [null, 0],
        ]) {
          const material = await library.material(model, 'brown', { light, crossings, leastWidth: 0 }),
            scene = new THREE.Scene();
          material.gains.value.set(gain, gain);
          scene.add(new THREE.Mesh(ribbons(strands), material), light, light.target);
          renderer.setRenderTarget(target);
          renderer.render(scene, camera);
          renderer.setRenderTarget(null);
          seen.push(meanOf(await renderer.readRenderTargetPixelsAsync(target, 0, 0, SIDE, SIDE), 4, SIDE ** 2));
        }
        for (const picture of pictures) {
          const bytes = Uint8Array.from(atob(picture), letter => letter.charCodeAt(0));
          truth.push(meanOf((await readLight(new File([bytes], 'picture.exr'))).data, 3, SIDE ** 2));
        }
        return { truth, seen };
      },
      { nodes, NODES, SIDE, model, pictures, sun: [column, SUN_ROW] },
    );
    const worst = truth.map((means, which) =>
      means
        .map((mean, c) => seen[which][c] / mean - 1)
        .reduce((most, error) => (Math.abs(error) > Math.abs(most) ? error : most)),
    );
    check(
      'light in the shadow of hair is that of hairis-render',
      Math.abs(worst[0]) < 0.06 &&
        Math.abs(worst[1]) < 0.1 &&
        seen[0][0] < 0.6 * seen[2][0] &&
        seen[1][0] > 1.1 * seen[0][0],
      `${model}: ${JSON.stringify({ seen, truth })}`,
    );
    console.log(
      `three.js: light of ${model}, ${(seen[2][0] / seen[0][0]).toFixed(1)} times as bright without shadow: once scattered that of hairis-render to ${(100 * worst[0]).toFixed(1)}%, by dual scattering, ${(seen[1][0] / seen[0][0]).toFixed(2)} times as bright, to ${(100 * worst[1]).toFixed(1)}%`,
    );
  }
  await page.close();
}
