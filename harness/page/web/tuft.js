// A tuft of hair under a map: strands are drawn here, and shaded by the generated WGSL on WebGPU or by the module.
//
// Each step draws directions from the light, the same for all pixels. What a pixel shows of a direction is S cos theta for the fibre
// that covers it, times the light that the tuft lets through. Both shaders get the same numbers, so that they can be compared.

const SIDE = 320,
  STRANDS = 1400,
  POINTS = 28,
  DIRECTIONS = 4,
  MOST_STEPS = 256,
  RADIUS = 0.9,
  SLICES = 48,
  OPACITY = 0.09;
const tuft = {
  steps: 0,
  sums: [],
  gpu: null,
  isGpu: false,
  isBusy: false,
  isSeen: false,
  generation: 0,
  times: { CPU: [], GPU: [] },
};

/// Uniform numbers that are the same on every visit.
function randomNumbers(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

/// Points of strands that leave a small patch at the top, spread, and hang.
function growTuft() {
  const random = randomNumbers(7),
    points = new Float32Array(3 * STRANDS * POINTS);
  for (let strand = 0, at = 0; strand < STRANDS; strand++) {
    const around = 2 * Math.PI * random(),
      out = Math.sqrt(random()),
      length = 1.5 + 0.35 * random(),
      wave = 0.02 + 0.035 * random(),
      phase = around * 3 + random();
    const [cos, sin] = [Math.cos(around), Math.sin(around)],
      spread = 0.18 + 0.5 * out + 0.06 * random();
    for (let i = 0; i < POINTS; i++, at += 3) {
      const t = i / (POINTS - 1),
        far = 0.05 * out + spread * (1 - (1 - t) ** 2) * 0.85,
        swing = wave * Math.sin(9 * t + phase) * t;
      points[at] = cos * far - sin * swing + 0.1 * t * t;
      points[at + 1] = 0.82 + 0.28 * Math.sin(Math.min(1, 1.6 * t) * Math.PI) * (0.35 + 0.65 * out) - length * t ** 1.5;
      points[at + 2] = sin * far + cos * swing;
    }
  }
  return points;
}

/// Axes of the picture: right, up and towards the viewer.
function cameraAxes() {
  const [turn, tilt] = state.camera,
    [ct, st, ci, si] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
  return [
    [ct, 0, -st],
    [-st * si, ci, -ct * si],
    [st * ci, si, ct * ci],
  ];
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/// The fibre that covers each pixel: its tangent, the offset across it, and its place.
function coverPixels([jitterX, jitterY]) {
  const [right, up, towards] = cameraAxes(),
    { points } = tuft,
    depth = new Float32Array(SIDE * SIDE).fill(-1e9),
    scale = SIDE / 2.25;
  const found = new Float32Array(7 * SIDE * SIDE);
  for (let strand = 0; strand < STRANDS; strand++) {
    let last = null;
    for (let i = 0; i < POINTS; i++) {
      const place = 3 * (strand * POINTS + i),
        p = [points[place], points[place + 1], points[place + 2]];
      const here = {
        p,
        x: SIDE / 2 + dot(p, right) * scale + jitterX,
        y: SIDE / 2 - (dot(p, up) - 0.05) * scale + jitterY,
        z: dot(p, towards),
      };
      if (last) coverSegment(last, here, depth, found);
      last = here;
    }
  }
  const pixels = [];
  for (let at = 0; at < SIDE * SIDE; at++) if (depth[at] > -1e9) pixels.push(at);
  return { pixels, found };
}

function coverSegment(a, b, depth, found) {
  const tangent = normalized([0, 1, 2].map(i => b.p[i] - a.p[i])),
    [dx, dy] = [b.x - a.x, b.y - a.y],
    length = Math.hypot(dx, dy),
    steps = Math.max(1, Math.ceil(length / 0.7));
  const [nx, ny] = length > 1e-6 ? [-dy / length, dx / length] : [1, 0];
  for (let step = 0; step < steps; step++) {
    const t = (step + 0.5) / steps,
      x = a.x + dx * t,
      y = a.y + dy * t,
      z = a.z + (b.z - a.z) * t;
    for (let py = Math.floor(y - RADIUS); py <= y + RADIUS; py++)
      for (let px = Math.floor(x - RADIUS); px <= x + RADIUS; px++) {
        if (px < 0 || py < 0 || px >= SIDE || py >= SIDE) continue;
        const [ox, oy] = [px + 0.5 - x, py + 0.5 - y],
          across = ox * nx + oy * ny,
          at = py * SIDE + px;
        if (Math.abs(across) > RADIUS || Math.abs(ox * ny - oy * nx) > 0.8 || z <= depth[at]) continue;
        depth[at] = z;
        found.set(
          [
            ...tangent,
            across / RADIUS,
            a.p[0] + (b.p[0] - a.p[0]) * t,
            a.p[1] + (b.p[1] - a.p[1]) * t,
            a.p[2] + (b.p[2] - a.p[2]) * t,
          ],
          7 * at,
        );
      }
  }
}

/// The share of the light from a direction that the tuft lets through to each pixel.
function shadows(dir, { pixels, found }, into, stride, offset) {
  const side = normalized(Math.abs(dir[1]) < 0.9 ? [-dir[2], 0, dir[0]] : [0, dir[2], -dir[1]]),
    up = [
      dir[1] * side[2] - dir[2] * side[1],
      dir[2] * side[0] - dir[0] * side[2],
      dir[0] * side[1] - dir[1] * side[0],
    ];
  const cells = shadows.cells.fill(0),
    { points } = tuft,
    place = x => Math.max(0, Math.min(SLICES - 1, ((x / 2.6 + 0.5) * SLICES) | 0));
  const cell = p => (place(dot(p, side)) * SLICES + place(dot(p, up))) * SLICES + SLICES - 1 - place(dot(p, dir));
  for (let at = 0; at < points.length; at += 3) cells[cell([points[at], points[at + 1], points[at + 2]])]++;
  for (let at = 0; at < cells.length; at++) if (at % SLICES) cells[at] += cells[at - 1];
  pixels.forEach((pixel, k) => {
    const at = cell([found[7 * pixel + 4], found[7 * pixel + 5], found[7 * pixel + 6]]);
    into[k * stride + offset] = Math.exp(-OPACITY * (at % SLICES ? cells[at - 1] : 0));
  });
}
shadows.cells = new Float32Array(SLICES ** 3);

/// The hits and lights of a step.
function nextStep() {
  const random = tuft.random,
    covered = coverPixels([random() - 0.5, random() - 0.5]),
    count = covered.pixels.length;
  const lights = Array.from({ length: DIRECTIONS }, (_, i) =>
    tuft.light.sample((i + random()) / DIRECTIONS, random(), random(), state.light.turn * RAD),
  );
  const seen = new Float32Array(4 * count),
    hits = new Float32Array(4 * count),
    wo = cameraAxes()[2];
  lights.forEach((light, i) => shadows(light.dir, covered, seen, 4, i));
  covered.pixels.forEach((pixel, k) => hits.set(covered.found.subarray(7 * pixel, 7 * pixel + 4), 4 * k));
  return { ...covered, count, lights, seen, hits, wo };
}

/// Light towards the viewer from each hit, by the module.
function shadeOnCpu(slot, { count, lights, seen, hits, wo }) {
  const [u, v, w, h, x, y, z, r, g, b] = kernel.work,
    out = new Float32Array(4 * count);
  lights.forEach(({ dir, radiance }, light) => {
    for (let k = 0; k < count; k++) {
      const t = hits.subarray(4 * k, 4 * k + 3),
        along = dot(wo, t),
        cos = Math.sqrt(Math.max(1e-12, 1 - along * along));
      const side = [0, 1, 2].map(i => (wo[i] - along * t[i]) / cos);
      u[k] = along;
      v[k] = cos;
      w[k] = 0;
      h[k] = hits[4 * k + 3];
      x[k] = dot(dir, t);
      y[k] = dot(dir, side);
      z[k] = dot(dir, [
        t[1] * side[2] - t[2] * side[1],
        t[2] * side[0] - t[0] * side[2],
        t[0] * side[1] - t[1] * side[0],
      ]);
    }
    kernel.calls.eval_hits(slot, count);
    for (let k = 0; k < count; k++) {
      const by = (Math.sqrt(y[k] * y[k] + z[k] * z[k]) * seen[4 * k + light]) / DIRECTIONS;
      out[4 * k] += r[k] * by * radiance[0];
      out[4 * k + 1] += g[k] * by * radiance[1];
      out[4 * k + 2] += b[k] * by * radiance[2];
    }
  });
  return out;
}

/// Shades with the module or on the GPU, and keeps the time.
async function shade(slot, step, isGpu) {
  const start = performance.now(),
    out = isGpu ? await tuft.gpu.shade(slot, step) : shadeOnCpu(slot, step),
    times = tuft.times[isGpu ? 'GPU' : 'CPU'];
  times.push(performance.now() - start);
  if (times.length > 40) times.shift();
  return out;
}

/// One step of both pictures, if the tuft is in view and not finished.
async function stepTuft() {
  if (!tuft.isSeen || tuft.isBusy || !tuft.isReady || tuft.steps >= MOST_STEPS || !tuft.light) return;
  tuft.isBusy = true;
  const { generation } = tuft;
  try {
    const step = nextStep();
    for (const slot of [0, 1]) {
      // The module shades one picture a frame, so that sliders stay quick.
      if (slot && !tuft.isGpu) await new Promise(requestAnimationFrame);
      const out = await shade(slot, step, tuft.isGpu);
      if (generation !== tuft.generation) return;
      const sums = tuft.sums[slot];
      step.pixels.forEach((pixel, k) => {
        for (let c = 0; c < 3; c++) sums[4 * pixel + c] += out[4 * k + c];
        sums[4 * pixel + 3]++;
      });
    }
    tuft.steps++;
    showTuft();
  } catch (error) {
    tuft.isGpu = false;
    tuft.gpu = null;
    tellTuft(`WebGPU stopped (${error.message}); the module goes on.`);
  } finally {
    tuft.isBusy = false;
  }
}

/// The pictures so far, both at one exposure.
function showTuft() {
  const { steps, sums } = tuft;
  if (steps <= 4) {
    let [sum, count] = [0, 0];
    for (const slot of [0, 1])
      for (let at = 0; at < sums[slot].length; at += 4)
        if (sums[slot][at + 3]) {
          sum += (sums[slot][at] + sums[slot][at + 1] + sums[slot][at + 2]) / 3;
          count += sums[slot][at + 3];
        }
    tuft.exposure = (0.22 * count) / Math.max(sum, 1e-9);
  }
  const by = (tuft.exposure * 2 ** state.light.exposure) / steps,
    ground = 0.018;
  for (const slot of [0, 1]) {
    const { context, image } = tuft.canvases[slot],
      { data } = image,
      from = sums[slot];
    for (let at = 0; at < data.length; at += 4) {
      const open = ground * (1 - from[at + 3] / steps);
      for (let c = 0; c < 3; c++) {
        data[at + c] = 255 * toSrgb(1 - Math.exp(-from[at + c] * by) + open);
      }
      data[at + 3] = 255;
    }
    context.putImageData(image, 0, 0);
  }
  tellTuft();
}

function tellTuft(text) {
  const by = tuft.isGpu ? 'GPU' : 'CPU',
    times = [...tuft.times[by]].sort((a, b) => a - b);
  if (text !== undefined) tuft.notice = text;
  $('tuft-note').textContent = [
    `${tuft.steps * DIRECTIONS} of ${MOST_STEPS * DIRECTIONS} directions of the light “${tuft.light?.name ?? ''}”, shaded by ${tuft.isGpu ? 'the generated WGSL on WebGPU' : 'the module on the CPU'}${times.length ? `, ${times[times.length >> 1].toFixed(1)} ms for ${DIRECTIONS}` : ''}.`,
    tuft.notice,
  ]
    .filter(Boolean)
    .join(' ');
}

/// Starts both pictures anew.
function restartTuft() {
  tuft.generation++;
  tuft.steps = 0;
  tuft.random = randomNumbers(1);
  tuft.sums = [0, 1].map(() => new Float32Array(4 * SIDE * SIDE));
  tuft.times = { CPU: [], GPU: [] };
  const { generation, gpu } = tuft;
  tuft.isReady = !gpu;
  gpu
    ?.prepare()
    .catch(error => {
      tuft.isGpu = false;
      tellTuft(`WebGPU did not take the shader: ${error.message}.`);
    })
    .then(() => {
      if (generation === tuft.generation) tuft.isReady = true;
    });
}

/// The largest difference between the two shaders over one step, of the largest value, and the times of both.
async function compareShaders() {
  tuft.isBusy = true;
  try {
    const step = nextStep();
    let [most, top] = [0, 0];
    const times = { CPU: [], GPU: [] };
    for (const slot of [0, 1]) {
      for (let run = 0; run < 5; run++)
        for (const [name, isGpu] of [
          ['CPU', false],
          ['GPU', true],
        ]) {
          const start = performance.now();
          times[`last ${name}`] = await (isGpu ? tuft.gpu.shade(slot, step) : shadeOnCpu(slot, step));
          times[name].push(performance.now() - start);
        }
      times['last CPU'].forEach((x, at) => {
        if (at % 4 < 3) {
          most = Math.max(most, Math.abs(x - times['last GPU'][at]));
          top = Math.max(top, x);
        }
      });
    }
    const median = list => list.sort((a, b) => a - b)[list.length >> 1];
    tuft.compared = { relative: most / top, cpu: median(times.CPU), gpu: median(times.GPU), count: step.count };
    tellTuft(
      `CPU and GPU differ by at most ${(most / top).toExponential(1)} of the brightest pixel; ${step.count} hits under ${DIRECTIONS} directions take ${tuft.compared.cpu.toFixed(1)} ms on the CPU and ${tuft.compared.gpu.toFixed(1)} ms on the GPU, with its copies.`,
    );
  } finally {
    tuft.isBusy = false;
  }
}

async function takeLight(file) {
  try {
    tuft.light = await readLight(file);
    refuse('');
    restartTuft();
  } catch (error) {
    refuse(`${file.name} was not read: ${error.message}.`);
  }
}

/// The card of the tuft: its pictures and controls.
function buildTuft() {
  tuft.points = growTuft();
  tuft.canvases = [0, 1].map(slot => {
    const canvas = make('canvas', {
      width: SIDE,
      height: SIDE,
      tabindex: 0,
      role: 'img',
      id: `tuft-${slot}`,
      'aria-label': `A tuft of material ${'AB'[slot]}; arrow keys turn it`,
    });
    const context = canvas.getContext('2d', { alpha: false });
    const turn = (x, y) => {
      state.camera = dragged(state.camera, [x, y], STATE.camera);
      restartTuft();
    };
    movable(
      canvas,
      (event, last) =>
        event !== last && turn((last.clientX - event.clientX) * 0.01, (event.clientY - last.clientY) * 0.01),
      ([x, y]) => turn(x * 0.1, y * 0.1),
    );
    return { canvas, context, image: context.createImageData(SIDE, SIDE) };
  });
  const input = make('input', {
    type: 'file',
    accept: '.hdr,.exr',
    'aria-label': 'Light map, Radiance or OpenEXR',
    hidden: true,
  });
  input.addEventListener('change', () => input.files[0] && takeLight(input.files[0]));
  const compare = make(
    'button',
    { type: 'button', id: 'compare', disabled: true, onclick: compareShaders },
    'Compare CPU and GPU',
  );
  fill(
    $('tuft'),
    make(
      'h2',
      {},
      'A tuft ',
      make('small', {}, 'drag or use the arrow keys to turn it; drop a Radiance or OpenEXR map on it to light it'),
    ),
    make(
      'div',
      { class: 'two' },
      ...[0, 1].map(slot =>
        make(
          'figure',
          { class: slot ? 'slot-b' : 'slot-a' },
          make('figcaption', {}, make('b', { class: 'chip', 'data-name': slot })),
          tuft.canvases[slot].canvas,
        ),
      ),
    ),
    make('div', { id: 'tuft-controls' }),
    make(
      'div',
      { class: 'bar' },
      make('button', { type: 'button', onclick: () => input.click() }, 'Light map…'),
      input,
      make(
        'button',
        {
          type: 'button',
          onclick: () => {
            tuft.light = skyLight();
            restartTuft();
          },
        },
        'Sky',
      ),
      compare,
    ),
    make('p', { class: 'note', id: 'tuft-note' }),
  );
  for (const name of ['dragover', 'dragleave', 'drop'])
    addEventListener(name, event => {
      event.preventDefault();
      $('tuft').classList.toggle('drop', name === 'dragover');
      if (name === 'drop' && event.dataTransfer.files[0]) takeLight(event.dataTransfer.files[0]);
    });
  new IntersectionObserver(([entry]) => {
    tuft.isSeen = entry.isIntersecting;
    if (!tuft.isSeen || tuft.light) return;
    tuft.light = skyLight();
    Gpu.start().then(
      gpu => {
        tuft.gpu = gpu;
        tuft.isGpu = true;
        compare.disabled = false;
        restartTuft();
      },
      error => tellTuft(`${error.message}.`),
    );
  }).observe($('tuft'));
}

/// Controls of the tuft that the state has.
function buildTuftControls() {
  const control = (name, shown, take) =>
    slider({
      ...shown,
      ...limited(STATE.light[name], shown.label, value => {
        state.light[name] = value;
        take();
        return '';
      }),
      get: () => state.light[name],
    });
  fill(
    $('tuft-controls'),
    control('turn', { label: 'light turn', unit: '°', range: [-180, 180] }, restartTuft),
    control('exposure', { label: 'exposure', unit: 'EV', range: [-4, 4] }, () => tuft.steps && showTuft()),
  );
}
