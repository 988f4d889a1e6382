// Tests of the three.js example, which harness/page/tests/page.mjs runs beside those of the page.
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { direct, paths } from './paths.mjs';
import {
  GIVEN,
  SIDE,
  SUN,
  cross,
  dot,
  draw,
  frameOf,
  hitOf,
  local,
  radiance,
  random,
  rayOf,
  snappedBy,
  sum,
  unit,
} from './scene.mjs';

/// A browser whose canvas shows what WebGPU draws in software.
const ARGUMENTS = [
  '--no-sandbox',
  '--enable-unsafe-webgpu',
  '--use-webgpu-adapter=swiftshader',
  '--enable-features=Vulkan',
  '--use-angle=swiftshader',
  '--use-vulkan=swiftshader',
  '--ignore-gpu-blocklist',
];

export async function three({ chromium, executablePath, address, check, evaluate, render, folder }) {
  const browser = await chromium.launch({ executablePath, args: ARGUMENTS });
  const open = async (path, viewport, gpu = true) => {
    const page = await browser.newPage({ viewport });
    if (!gpu)
      await page.addInitScript(() => Object.defineProperty(Navigator.prototype, 'gpu', { get: () => undefined }));
    page.on('console', message =>
      check('the console of three.js has no error', !['error', 'warning'].includes(message.type()), message.text()),
    );
    page.on('pageerror', error => check('three.js throws no error', false, `${error.message} ${error.stack}`));
    page.on('request', request =>
      check(
        'nothing is loaded from elsewhere',
        request.url().startsWith(address) || request.url().startsWith('blob:'),
        request.url(),
      ),
    );
    await page.goto(address + path);
    return page;
  };
  const drawn = page =>
    page.waitForFunction(() => globalThis.hairis?.frames > 0 || document.getElementById('refusal').textContent, null, {
      timeout: 90_000,
    });

  const page = await open('three/?every=500&model=kajiya-kay', { width: 480, height: 800 });
  await drawn(page);
  // The last presets but one are black, and the first of some return more light than arrives.
  const presets = await page.evaluate(() =>
    hairis.library.models.map(model => Object.values(hairis.library.presets(model)).map(values => ({ model, values }))),
  );
  await values(
    page,
    presets.map(list => list.at(-2)),
    check,
    evaluate,
  );
  await environments(
    page,
    presets.map(list => list[0]),
    check,
    evaluate,
  );
  await shadows(page, check);
  await page.close();
  await panel(open, drawn, check);
  await readme(browser, { address, check, folder });
  await direct({ open, check, render });
  await paths({ open, check, render });
  await browser.close();
}

/// Offsets of a mean over the fibre, with their weights: evenly around it.
const OFFSETS = Array.from({ length: 32 }, (_, i) => {
  const angle = (Math.PI * (i - 15.5)) / 32;
  return [Math.sin(angle), (Math.cos(angle) * Math.PI) / 64];
});

/// Pixels under the directional light are those of `hairis eval`.
async function values(page, materials, check, evaluate) {
  let [count, worst, widest] = [0, 0, 0];
  for (const { model, values } of materials) {
    const { near } = await page.evaluate(model => ({ near: hairis.library.description(model).near_field }), model);
    for (const lines of [false, true]) {
      const { pixels } = await draw(page, { ...GIVEN, model, values, lines });
      const [requests, shown] = [[], []];
      for (let row = 0; row < SIDE; row++)
        for (let column = 0; column < SIDE; column++) {
          const at = 4 * (SIDE * row + column),
            ray = rayOf(column, row),
            hit = hitOf(ray);
          // Lines are one pixel wide, so that their pixels are near the axes.
          if (!hit || !(pixels[at + 3] > 0) || (row * 7 + column * 3) % (lines ? 3 : 211)) continue;
          const frame = frameOf(
              hit.along,
              ray.map(x => -x),
            ),
            [wo, wi] = [ray.map(x => -x), SUN].map(a => local(frame, a));
          shown.push({ color: pixels.slice(at, at + 3), cosine: Math.hypot(wi[1], wi[2]) });
          const moved = snappedBy(hit),
            offsets = !near
              ? [undefined]
              : lines
                ? OFFSETS.map(([h]) => h)
                : [-1, 0, 1].map(step => step * moved - hit.across);
          requests.push(...offsets.map(h => ({ model, params: values, wo, wi, ...(near && { h }) })));
        }
      const answers = evaluate(requests),
        per = requests.length / shown.length,
        peak = Math.max(...shown.map(({ color }) => color[0]));
      check('pixels are compared', shown.length > 20, `${model}: ${shown.length}`);
      const means = [0, 0];
      shown.forEach(({ color, cosine }, i) =>
        color.forEach((value, c) => {
          const seen = answers.slice(per * i, per * i + per).map(({ s }) => 2 * [1, 0.8, 0.6][c] * s[c] * cosine),
            [low, high] = [Math.min(...seen), Math.max(...seen)],
            error = Math.max(0, low - value, value - high) / (high + 0.01 * peak);
          if (lines && near) {
            means[0] += value;
            means[1] += seen.reduce((total, s, j) => total + OFFSETS[j][1] * s, 0);
            return;
          }
          if (!lines)
            [count, worst, widest] = [
              count + 1,
              Math.max(worst, error),
              Math.max(widest, (high - low) / (high + 0.01 * peak)),
            ];
          // A pixel of a line is up to half a pixel from the axis, where the ribbon shows the direction of its own pixel.
          check(
            'pixels are those of hairis eval',
            error < (lines ? 0.02 : 2e-3),
            `${model}${lines ? ', lines' : ''}: ${value} and ${seen}`,
          );
        }),
      );
      // The offsets of a line differ by pixel, so that means over pixels agree.
      if (lines && near)
        check(
          'lines have the mean over the fibre',
          Math.abs(means[0] / means[1] - 1) < 0.05,
          `${model}: ${means}, ${shown.length} pixels`,
        );
    }
  }
  console.log(
    `three.js: ${count} numbers of pixels are those of hairis eval, to ${worst.toExponential(1)} where corners lie within 1/16 of a pixel, which is ${(100 * widest).toFixed(1)}% of a number at most`,
  );
}

/// Light from all around: quadratures of `hairis eval`, and no more than arrives.
async function environments(page, materials, check, evaluate) {
  const next = random(3),
    white = [[3.5449077, 3.5449077, 3.5449077]],
    uneven = [...white, ...Array.from({ length: 8 }, () => [0, 1, 2].map(() => 0.5 * (next() - 0.5)))];
  const clear = materials
    .filter(({ model }) => model === 'chiang')
    .slice(0, 1)
    .map(({ model, values: { sigma_a, color, melanin, ...rest } }) => ({
      model,
      values: { ...rest, sigma_a: [0, 0, 0] },
    }));
  let [top, scaled] = [0, false];
  for (const { model, values } of [...materials, ...clear]) {
    const { pixels } = await draw(page, { ...GIVEN, light: 0, harmonics: white, model, values });
    top = pixels.reduce((most, x, at) => (at % 4 < 3 ? Math.max(most, x) : most), 0);
    check('hair returns no more than arrives', top > 0 && top <= 1 + 1e-5, `${model}: ${top}`);
  }
  check('hair without absorption returns what arrives', top > 0.97, `${top}`);
  let worst = 0;
  for (const { model, values } of materials.filter(({ model }) => ['gaussian', 'chiang'].includes(model))) {
    const [around, lit] = [
      [0, uneven],
      [2, []],
    ].map(([light, harmonics]) => draw(page, { ...GIVEN, light, harmonics, model, values }));
    const pictures = [(await around).pixels, (await lit).pixels];
    for (const [column, row] of [
      [100, 140],
      [160, 100],
    ]) {
      // The next pixel to the right that shows a strand.
      let place = [column, row];
      while (!hitOf(rayOf(...place))) place = [place[0] + 1, row];
      const ray = rayOf(...place),
        hit = hitOf(ray),
        frame = frameOf(
          hit.along,
          ray.map(x => -x),
        ),
        wo = local(
          frame,
          ray.map(x => -x),
        ),
        [rows, columns] = [24, 48],
        near = model === 'chiang',
        wi = local(frame, SUN),
        [requests, factors] = [[{ model, params: values, wo, wi, ...(near && { h: -hit.across }) }], []];
      for (let i = 0; i < rows; i++)
        for (let j = 0; j < columns; j++) {
          const theta = Math.PI * ((i + 0.5) / rows - 0.5),
            phi = 2 * Math.PI * ((j + 0.5) / columns - 0.5),
            cos = Math.cos(theta),
            wi = [Math.sin(theta), cos * Math.cos(phi), cos * Math.sin(phi)],
            light = radiance(
              uneven,
              sum(
                sum(
                  frame[0].map(x => x * wi[0]),
                  frame[1],
                  wi[1],
                ),
                frame[2],
                wi[2],
              ),
            );
          for (const [h, weight] of near ? OFFSETS : [[undefined, 1]]) {
            requests.push({ model, params: values, wo, wi, ...(near && { h }) });
            factors.push([1, ...light].map(x => (x * weight * cos * cos * 2 * Math.PI ** 2) / (rows * columns)));
          }
        }
      const [{ s: direct }, ...answers] = evaluate(requests),
        at = 4 * (SIDE * place[1] + place[0]);
      for (let c = 0; c < 3; c++) {
        const [albedo, integral] = [0, 1 + c].map(which =>
            answers.reduce((total, { s }, i) => total + s[c] * factors[i][which], 0),
          ),
          factor = 1 / Math.max(1, albedo),
          error = Math.abs(pictures[0][at + c] / (factor * integral) - 1),
          expected = 2 * [1, 0.8, 0.6][c] * factor * direct[c] * Math.hypot(wi[1], wi[2]);
        worst = Math.max(worst, error);
        scaled ||= factor < 0.9;
        check(
          'light from all around is the integral',
          error < 0.01,
          `${model} ${place}: ${pictures[0][at + c]} and ${factor * integral}`,
        );
        // Of the near field, corners of ribbons move the offset.
        if (!near)
          check(
            'direct light is scaled alike',
            Math.abs(pictures[1][at + c] / expected - 1) < 0.01,
            `${model} ${place}: ${pictures[1][at + c]} and ${expected}`,
          );
      }
    }
  }
  check('a material is scaled', scaled);
  console.log(
    `three.js: light from all around is the integral of hairis eval to ${(100 * worst).toFixed(1)}%, and white light stays white`,
  );
}

/// Crossings are the strands that rays meet, as a mean; what they dim has the colour of the forward albedo.
async function shadows(page, check) {
  const next = random(9),
    RADIUS = 0.02,
    sun = unit([0.3, 1, 0.4]),
    SCENE = Array.from({ length: 900 }, () => {
      const middle = [0, 1, 2].map(() => 3 * (next() - 0.5)),
        lean = unit([next() - 0.5, 2 * (next() - 0.5), next() - 0.5]);
      return [-0.4, 0.4].map(t => sum(middle, lean, t));
    });
  const places = Array.from({ length: 400 }, () => [0, 1, 2].map(() => 2 * (next() - 0.5)));
  const counts = await page.evaluate(
    ({ SCENE, RADIUS, sun, places }) => {
      const { THREE, Crossings, Strands } = hairis,
        nodes = Float32Array.from(SCENE.flatMap(ends => ends.flatMap(p => [...p, RADIUS])));
      const crossings = new Crossings(
        new Strands(
          nodes,
          Uint32Array.from(SCENE, (_, i) => 2 * i + 2),
        ),
        32,
      );
      crossings.update(new THREE.Vector3(...sun));
      const { low, side, size, data } = crossings;
      return places.map(p => {
        const [x, y, z] = p.map((v, axis) => Math.floor(((v - low.getComponent(axis)) / side) * size));
        return THREE.DataUtils.fromHalfFloat(data[2 * (x + size * (y + size * z))]);
      });
    },
    { SCENE, RADIUS, sun, places },
  );
  let [met, high, low] = [0, [0, 0, 0], [0, 0, 0]];
  places.forEach((place, i) => {
    let own = 0;
    for (const [a, b] of SCENE) {
      const step = sum(b, a, -1),
        normal = cross(step, sun),
        away = sum(a, place, -1);
      if (Math.abs(dot(away, normal)) > RADIUS * Math.hypot(...normal)) continue;
      // Nearest places of the strand and the ray.
      const [s, t] = [-dot(cross(away, sun), normal), -dot(cross(away, step), normal)].map(
        x => x / dot(normal, normal),
      );
      if (s > 0 && s < 1 && t > 0) own++;
    }
    met += own;
    const group = place[1] > 0 ? high : low;
    group[0]++;
    group[1] += own;
    group[2] += counts[i];
  });
  const mean = counts.reduce((a, b) => a + b) / counts.length,
    error = Math.sqrt(met) / places.length;
  check(
    'crossings are the strands that rays meet',
    Math.abs(mean - met / places.length) < 3.5 * error,
    `${mean} and ${met / places.length}`,
  );
  for (const [n, cast, looked] of [high, low])
    check(
      'crossings grow with depth',
      Math.abs(looked - cast) < 3.5 * Math.sqrt(cast),
      `${looked / n} and ${cast / n}`,
    );
  console.log(
    `three.js: ${mean.toFixed(2)} crossings in the mean, and ${(met / places.length).toFixed(2)} ± ${error.toFixed(2)} by rays`,
  );

  const { ratios, forward } = await page.evaluate(
    async ({ SCENE, RADIUS }) => {
      const { THREE, Crossings, Strands, library, renderer, ribbons } = hairis,
        strands = new Strands(
          Float32Array.from(SCENE.flatMap(ends => ends.flatMap(p => [...p, RADIUS]))),
          Uint32Array.from(SCENE, (_, i) => 2 * i + 2),
        );
      const environment = new THREE.SphericalHarmonics3(),
        camera = new THREE.PerspectiveCamera(40, 1, 0.1, 50),
        target = new THREE.RenderTarget(64, 64, { type: THREE.FloatType });
      environment.coefficients[0].setScalar(3.5449077);
      camera.position.set(0, 0, 6);
      const pictures = [];
      let forward;
      for (const crossings of [null, new Crossings(strands)]) {
        const material = await library.material(
            'kajiya-kay',
            { kd: [0.5, 0.3, 0.1], ks: [0, 0, 0], exponent: 10 },
            { environment, crossings },
          ),
          scene = new THREE.Scene();
        scene.add(new THREE.Mesh(ribbons(strands), material));
        renderer.setRenderTarget(target);
        renderer.render(scene, camera);
        renderer.setRenderTarget(null);
        pictures.push(await renderer.readRenderTargetPixelsAsync(target, 0, 0, 64, 64));
        forward = material.forward.value.toArray();
      }
      const ratios = [];
      for (let at = 0; at < pictures[0].length; at += 4)
        if (pictures[0][at + 3] > 0 && pictures[0][at + 2] > 1e-4)
          ratios.push([0, 1, 2].map(c => Math.log(pictures[1][at + c] / pictures[0][at + c])));
      return { ratios, forward };
    },
    { SCENE, RADIUS },
  );
  const total = [0, 1, 2].map(c => ratios.reduce((a, one) => a + one[c], 0) / ratios.length);
  check('strands are in shadow', ratios.length > 500 && total[0] < -0.3, `${ratios.length}, ${total}`);
  for (const c of [1, 2]) {
    const [a, b] = [total[c] / total[0], (1 - forward[c]) / (1 - forward[0])];
    check('shadows have the colour of what passes', Math.abs(a / b - 1) < 1e-3 && a > 1.01, `${a} and ${b}`);
  }
}

/// The page itself at two widths: its controls change what is drawn.
async function panel(open, drawn, check) {
  for (const width of [1280, 390]) {
    const page = await open('three/?every=60&model=gaussian', { width, height: 780 });
    await drawn(page);
    check(
      'three.js starts',
      (await page.locator('#refusal').textContent()) === '',
      await page.locator('#refusal').textContent(),
    );
    check(
      'nothing is cut off',
      await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth),
      `three.js, ${width}`,
    );
    const picture = async () => {
      await page.waitForFunction(() => !hairis.isStale && !hairis.isBusy && !hairis.pending);
      return createHash('sha1')
        .update(await page.locator('#view').screenshot())
        .digest('hex');
    };
    const seen = [await picture()];
    const change = async what => {
      seen.push(await picture());
      check('a control changes the picture', new Set(seen).size === seen.length, `${what}, ${width}`);
    };
    await page.getByLabel('azimuth, °').fill('-120');
    await change('azimuth');
    if (width === 390) {
      await page.close();
      continue;
    }
    await page.getByLabel('preset').selectOption('red');
    await change('preset');
    await page.getByLabel('beta R, °').fill('14');
    await change('beta');
    await page.getByLabel('beta R, °').fill('-4');
    check(
      'a refusal is a sentence',
      (await page.locator('#refusal').textContent()).startsWith('beta[0] must be a width'),
      await page.locator('#refusal').textContent(),
    );
    await page.getByLabel('other strands').uncheck();
    await change('shadows');
    await page.getByRole('button', { name: 'Lines' }).click();
    await change('lines');
    await page.getByLabel('model').selectOption('cauchy');
    await change('model');
    await page.close();
  }
  for (const path of ['three/', 'three/paths.html']) {
    const page = await open(path, { width: 800, height: 600 }, false);
    await page.waitForFunction(() => document.getElementById('refusal').textContent);
    const text = await page.locator('#refusal').textContent();
    check('without WebGPU there is a sentence', text.includes('This browser has no WebGPU'), `${path}: ${text}`);
    await page.close();
  }
  console.log('three.js: 1280 and 390 pixels, panel, lines and shadows, without WebGPU');
}

/// The lines of the README, in a scene of their own with the three.js of npm: something is drawn.
async function readme(browser, { address, check, folder }) {
  const page = await browser.newPage(),
    [, lines] = readFileSync(new URL('three.md', import.meta.url), 'utf8').match(/```js\n(.*?)```/s),
    at = `${address}three/`;
  page.on('pageerror', error => check('the lines of the README throw no error', false, error.message));
  await page.route(`${at}node/*`, route =>
    route.fulfill({
      path: join(folder, '../three-build/node_modules/three/build', basename(route.request().url())),
      contentType: 'text/javascript',
    }),
  );
  await page.route(`${at}hairis/*`, route =>
    route.fulfill({ path: join(folder, 'three', basename(route.request().url())) }),
  );
  await page.route(`${at}readme.html`, route =>
    route.fulfill({
      contentType: 'text/html',
      body: `<script type="importmap">{ "imports": { "three/webgpu": "./node/three.webgpu.js", "three/tsl": "./node/three.tsl.js" } }</script>
        <script type="module">import * as THREE from 'three/webgpu'; Object.assign(globalThis, { THREE, scene: new THREE.Scene() });</script>
        <script type="module">${lines}; globalThis.isDone = true;</script>`,
    }),
  );
  await page.goto(`${at}readme.html`);
  await page.waitForFunction(() => globalThis.isDone, null, { timeout: 60_000 });
  const lit = await page.evaluate(async () => {
    const renderer = new THREE.WebGPURenderer(),
      camera = new THREE.PerspectiveCamera(30, 1, 1, 500),
      target = new THREE.RenderTarget(48, 48, { type: THREE.FloatType });
    await renderer.init();
    camera.position.set(30, 0, 90);
    camera.lookAt(0, 0, 0);
    renderer.setRenderTarget(target);
    renderer.render(scene, camera);
    const pixels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, 48, 48);
    return pixels.filter((x, i) => i % 4 === 0 && x > 1e-3).length;
  });
  check('the lines of the README draw hair', lit > 100, `${lit}`);
  console.log(`three.js: the lines of the README draw ${lit} pixels of hair`);
  await page.close();
}
