/// The page of the path tracer: the hair of the example under a map of light, one sample of each pixel after the other.
import { fill, make, materialPanel, newMaterial, readLight, refuse, skyLight, slider, toSrgb } from '#page';
import { Models } from './models.js';
import { scattering } from './scattering.js';
import { Strands } from './strands.js';
import { Tracer } from './tracer.js';

const $ = id => document.getElementById(id),
  SIDE = 480,
  MOST_STEPS = 4096,
  /// A head has some 100,000 hairs. The file has fewer, which are as much thicker.
  WIDER = 4;
const state = { around: 0.55, up: 0.12, distance: 3.4, exposure: 1.5, light: 'sky' };
/// The page's tracer, for the console and for tests.
const page = (globalThis.hairis = { Models, Strands, Tracer, readLight, scattering, state, tracer: null, steps: 0 });

async function start() {
  const [models, file] = await Promise.all([Models.load(), fetch('groom.hair').then(answer => answer.arrayBuffer())]);
  // `?every=20&model=gaussian&side=96`: as much hair as a driver in software traces, the model at first, and pixels along each side.
  const query = new URLSearchParams(location.search),
    step = Number(query.get('every')) || 1,
    side = Number(query.get('side')) || SIDE,
    strands = Strands.read(file).every(step, WIDER * Math.sqrt(step)),
    tracer = await Tracer.start(strands),
    { low, high } = strands.box,
    centre = low.map((x, axis) => (x + high[axis]) / 2),
    radius = Math.hypot(...low.map((x, axis) => high[axis] - x)) / 2;
  const canvas = make('canvas', {
      width: side,
      height: side,
      tabindex: 0,
      role: 'img',
      'aria-label': 'Hair; drag or use the arrow keys to turn it',
    }),
    context = canvas.getContext('2d', { alpha: false }),
    image = context.createImageData(side, side);
  $('view').append(canvas);
  Object.assign(page, { models, tracer });

  let generation = 0,
    isReady = false,
    time = 0;
  const restart = () => {
    const { around, up, distance } = state,
      eye = [Math.sin(around) * Math.cos(up), Math.sin(up), Math.cos(around) * Math.cos(up)].map(
        (x, axis) => centre[axis] + distance * radius * x,
      );
    tracer.setView({ eye, at: centre, slope: Math.tan(Math.PI / 12), backdrop: [0.007, 0.008, 0.009] }, side);
    tracer.restart();
    page.steps = 0;
    generation++;
  };
  async function shown({ model, values }, isOther) {
    const { kernel } = models,
      refusal = kernel.setMaterial(0, { model, values });
    if (refusal) return refusal;
    const { table } = scattering(kernel, { model, values }),
      constants = kernel.work[0].slice(0, kernel.calls.constants(0));
    if (isOther) isReady = false;
    try {
      await tracer.setMaterial(await models.source(model, '.paths.wgsl'), constants, table);
    } catch (error) {
      refuse(`The shader of ${model} did not compile: ${error.message}`);
      return '';
    }
    restart();
    isReady = true;
    return '';
  }
  tracer.setMap(skyLight());
  restart();

  const show = sums => {
    const by = 2 ** state.exposure;
    for (let at = 0; at < sums.length; at += 4) {
      for (let c = 0; c < 3; c++) image.data[at + c] = 255 * toSrgb(1 - Math.exp((-sums[at + c] * by) / sums[at + 3]));
      image.data[at + 3] = 255;
    }
    context.putImageData(image, 0, 0);
  };
  let sums = null;
  async function go() {
    const now = generation;
    if (isReady && tracer.steps < MOST_STEPS) {
      const begin = performance.now();
      await tracer.step();
      time = performance.now() - begin;
      // The first samples as they come, and of the others every eighth.
      if (now === generation && (tracer.steps < 8 || tracer.steps % 8 === 0)) {
        sums = await tracer.read();
        if (now === generation) show(sums);
      }
      page.steps = tracer.steps;
      $('note').textContent =
        `${strands.ends.length} strands, ${strands.count} segments; ${tracer.steps} of ${MOST_STEPS} samples of each pixel, ${time.toFixed(0)} ms for one. Paths of any length.`;
    }
    requestAnimationFrame(go);
  }

  const turn = (x, y) => {
    state.around += x;
    state.up = Math.max(-1.5, Math.min(1.5, state.up + y));
    restart();
  };
  canvas.addEventListener('pointermove', event => {
    if (event.buttons & 1) turn(-event.movementX * 0.01, event.movementY * 0.01);
  });
  canvas.addEventListener('pointerdown', event => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener(
    'wheel',
    event => {
      event.preventDefault();
      state.distance = Math.max(1.2, Math.min(12, state.distance * Math.exp(event.deltaY * 0.001)));
      restart();
    },
    { passive: false },
  );
  canvas.addEventListener('keydown', event => {
    const by = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
    if (by) event.preventDefault();
    if (by) turn(...by);
  });
  const input = make('input', {
    type: 'file',
    accept: '.hdr,.exr',
    'aria-label': 'Light map, Radiance or OpenEXR',
    hidden: true,
  });
  input.addEventListener('change', async () => {
    const [file] = input.files;
    try {
      tracer.setMap(await readLight(file));
      refuse('');
      restart();
    } catch (error) {
      refuse(`${file.name} was not read: ${error.message}.`);
    }
  });
  fill(
    $('light'),
    slider({
      label: 'exposure',
      unit: 'EV',
      range: [-4, 4],
      get: () => state.exposure,
      set: value => ((state.exposure = value), sums && show(sums), ''),
    }),
    make(
      'div',
      { class: 'bar' },
      make('button', { type: 'button', onclick: () => input.click() }, 'Light map…'),
      input,
      make('button', { type: 'button', onclick: () => (tracer.setMap(skyLight()), restart()) }, 'Sky'),
    ),
  );
  go();
  await materialPanel(models.kernel, newMaterial(models.description(query.get('model') ?? 'chiang')), shown);
}

start().catch(error => refuse(`The page did not start: ${error.message}.`));
