// The page: draws what the state says, and listens.

const maps = [0, 1].map(() => new Float32Array(WIDTH * HEIGHT)),
  differences = new Float32Array(WIDTH * HEIGHT);
const figures = { maps: [{}, {}], difference: {}, variance: [null, null], times: [] };
let canvases,
  isScheduled = false,
  later = 0,
  drawn = [[], []],
  tallies = [];
const isReduced = matchMedia('(prefers-reduced-motion: reduce)');

/// Gives the module the state's materials; a refusal as text, or nothing. Otherwise the page is drawn again.
function changed() {
  for (const slot of [0, 1]) {
    const refusal = kernel.setMaterial(slot, materialOf(slot));
    if (refusal) {
      for (const other of [0, 1].slice(0, slot)) kernel.setMaterial(other, materialOf(other));
      return refusal;
    }
  }
  refuse('');
  schedule();
  return '';
}

function schedule() {
  if (isScheduled) return;
  isScheduled = true;
  requestAnimationFrame(() => {
    isScheduled = false;
    draw();
  });
}

function setView(slot) {
  kernel.setView(slot, state.view, state.lobes);
}

function draw() {
  const start = performance.now();
  for (const slot of [0, 1]) drawMap(slot);
  figures.difference = measureDifference(maps[0], maps[1], differences);
  drawMaps();
  figures.times.push(performance.now() - start);
  if (figures.times.length > 400) figures.times.shift();
  drawn = [[], []];
  tallies = [newTally(), newTally()];
  drawPlots();
  describe();
  figures.variance = [null, null];
  clearTimeout(later);
  later = setTimeout(() => {
    settle(true);
    later = setTimeout(settle, 100);
  }, 0);
  restartTuft();
}

/// Figures that take longer than a frame: at first a quick look, and the rest once nothing moves.
function settle(isQuick = false) {
  for (const slot of [0, 1]) {
    setView(slot);
    const { entries } = kernel.model(state.materials[slot].model);
    figures.variance[slot] = { entries, lights: measureVariance(slot, entries, isQuick), isSettled: !isQuick };
  }
  drawVariance();
  drawAlbedo();
  drawSurfaces($('surface'), maps, peakOf(), state.turn);
  answer();
  texts();
}

/// Evaluates and measures the map of a slot.
function drawMap(slot) {
  setView(slot);
  kernel.calls.eval(slot, kernel.entry(state.materials[slot]).model, true, MAP.count);
  figures.maps[slot] = measureMap(kernel.maps[slot], maps[slot]);
}

/// Colours of the maps by the upper half of a number's bits.
function colorTable(most) {
  const isLog = state.scale === 'log',
    last = STEPS - 1,
    by = last / (isLog ? DECADES * Math.LN10 : most),
    shift = isLog ? last - Math.log(most) * by : 0;
  return table(
    value => {
      const at = isLog ? shift + Math.log(value) * by : value * by;
      return VIRIDIS_STEPS[at > 0 ? (at < last ? at | 0 : last) : 0];
    },
    colorTable.entries,
    32768,
  );
}
colorTable.entries = new Uint32Array(65536);
const peakOf = () => Math.max(figures.maps[0].peak, figures.maps[1].peak, 1e-12);

function drawMaps() {
  const peak = peakOf(),
    { show, scale } = state;
  if (show === 'color') {
    const tone = toneOf(peak);
    [0, 1].forEach(slot => canvases[slot].paintColor(kernel.maps[slot], tone));
  } else {
    const densities = [0, 1].map(slot => kernel.maps[slot][6].subarray(0, MAP.count));
    const shown = show === 'pdf' ? densities : maps;
    const most = show === 'pdf' ? Math.max(...densities.map(map => map.reduce((a, b) => Math.max(a, b), 1e-12))) : peak;
    const colorsOf = colorTable(most);
    shown.forEach((map, slot) => canvases[slot].paint(map, colorsOf));
    const ticks =
      scale === 'log'
        ? Array.from({ length: DECADES + 2 }, (_, i) => 10 ** (Math.floor(Math.log10(most)) - i))
            .map(value => ({ at: position(value, most, 'log'), text: tidy(value) }))
            .filter(({ at }) => at >= 0)
            .reverse()
        : Array.from({ length: 6 }, (_, i) => ({ at: i / 5, text: tidy((most * i) / 5) }));
    ticks[ticks.length - 1].text += show === 'pdf' ? ' per sr, density' : ' per sr, S cos θ';
    drawScale($('scale'), t => onScale(VIRIDIS, t), ticks);
  }
  $('scale').style.visibility = show === 'color' ? 'hidden' : '';
  const most = Math.max(figures.difference.peak, 1e-12);
  canvases[2].paint(
    differences,
    table(
      value =>
        DIVERGING_STEPS[
          Math.max(0, Math.min(STEPS - 1, Math.round(((signedPosition(value, most) + 1) / 2) * (STEPS - 1))))
        ],
    ),
  );
  drawScale(
    $('signed-scale'),
    t => onScale(DIVERGING, t),
    [-1, -0.1, 0, 0.1, 1].map(x => ({ at: (signedPosition(x, 1) + 1) / 2, text: minus(tidy(x * most)) })),
  );
  canvases.forEach(canvas => canvas.mark(state.cut, state.view.theta));
}

/// Tables from radiance to bytes of sRGB, one per row for its cosine, in 32 steps; kept as long as the peak stays within a power of 2.
function toneOf(peak) {
  const power = Math.ceil(Math.log2(peak));
  if (toneOf.power === power) return toneOf.tone;
  const by = 10 / 2 ** power,
    steps = Array.from({ length: 33 }, (_, i) => {
      const bytes = Uint8Array.from({ length: STEPS }, (_, at) => Math.round(255 * toSrgb(at / (STEPS - 1))));
      return table(
        value => {
          const x = value * (i / 32) * by;
          return bytes[Math.min(STEPS - 1, ((x / (1 + x)) * (STEPS - 1)) | 0)];
        },
        new Uint8Array(65536),
        32640,
      );
    });
  toneOf.power = power;
  return (toneOf.tone = { rows: Array.from(MAP.cos, cos => steps[Math.round(32 * cos)]) });
}

const ALONG = Array.from({ length: 721 }, (_, i) => -90 + i / 4),
  AROUND = Array.from({ length: 721 }, (_, i) => -180 + i / 2);
const DASHES = [
  [5, 3],
  [2, 2],
  [9, 3, 2, 3],
  [1, 3],
];

function drawPlots() {
  const lines = [[], []];
  for (const slot of [0, 1]) {
    const model = kernel.model(state.materials[slot].model),
      entry = kernel.entry(state.materials[slot]);
    const lobes = model.lobes.map((_, lobe) => lobe).filter(lobe => (state.lobes >> lobe) & 1);
    const masks = [state.lobes, ...(lobes.length > 1 ? lobes.map(lobe => 1 << lobe) : [])];
    [ALONG.map(theta => direction(theta, state.cut.phi)), AROUND.map(phi => direction(state.cut.theta, phi))].forEach(
      (directions, which) =>
        profile(slot, entry, state.view, masks, directions).forEach((y, place) =>
          lines[which].push({
            x: which ? AROUND : ALONG,
            y,
            color: colors.slots[slot],
            dash: place ? DASHES[lobes[place - 1]] : [],
            weight: place ? 1 : 2,
          }),
        ),
    );
    setView(slot);
  }
  ['along', 'around'].forEach((id, which) => {
    const peaks = lines[which]
      .filter(({ weight }) => weight === 2)
      .map(({ x, y }) => {
        const top = y.indexOf(Math.max(...y));
        return `${tidy(y[top])} per steradian at ${x[top]} degrees`;
      });
    $(id).setAttribute(
      'aria-label',
      `S cos theta ${id} the fibre: ${titleOf(0)} peaks with ${peaks[0]}, ${titleOf(1)} with ${peaks[1]}`,
    );
  });
  const log = state.scale === 'log',
    order = lines => [...lines].sort((a, b) => a.weight - b.weight);
  plot($('along'), {
    lines: order(lines[0]),
    range: [-90, 90],
    ticks: 30,
    label: 'θᵢ',
    unit: 'S cos θ, per sr',
    log,
    marker: state.cut.theta,
  });
  plot($('around'), {
    lines: order(lines[1]),
    range: [-180, 180],
    ticks: $('around').clientWidth < 420 ? 90 : 45,
    label: 'φᵢ',
    unit: 'S cos θ, per sr',
    log,
    marker: state.cut.phi,
  });
}

function drawAlbedo() {
  const inclinations = Array.from({ length: 59 }, (_, i) => -87 + 3 * i),
    lines = [];
  for (const slot of [0, 1])
    albedoCurves(slot, kernel.model(state.materials[slot].model), state.lobes, inclinations).forEach((y, place) =>
      lines.push({
        x: inclinations,
        y,
        color: colors.slots[slot],
        dash: place ? [] : [5, 3],
        weight: place ? 2 : 1.5,
      }),
    );
  figures.albedo = lines;
  $('albedo').setAttribute(
    'aria-label',
    `Albedo of ${titleOf(0)} from ${tidy(Math.min(...lines[1].y))} to ${tidy(Math.max(...lines[1].y))}, of ${titleOf(1)} from ${tidy(Math.min(...lines[3].y))} to ${tidy(Math.max(...lines[3].y))}`,
  );
  plot($('albedo'), {
    lines,
    range: [-90, 90],
    ticks: 30,
    label: 'θₒ',
    unit: 'albedo, mean of RGB',
    marker: state.view.theta,
    top: Math.max(1.05, ...lines.flatMap(({ y }) => y)),
    guides: [1],
  });
}

const newTally = () => ({ count: 0, sum: 0, square: 0 });

/// Draws some samples, and drops them on the maps.
function fall(count) {
  for (const slot of [0, 1]) {
    const [s, t, u, x, y, z, wr, wg, wb, , lobe] = kernel.work,
      dots = [];
    for (let i = 0; i < count; i++) for (const column of [s, t, u]) column[i] = Math.min(Math.random(), 1 - 2 ** -24);
    setView(slot);
    kernel.calls.sample(slot, kernel.entry(state.materials[slot]).model, count);
    for (let i = 0; i < count; i++) {
      const weight = (wr[i] + wg[i] + wb[i]) / 3,
        tally = tallies[slot];
      tally.count++;
      tally.sum += weight;
      tally.square += weight * weight;
      if (lobe[i] >= 0) dots.push(MAP.cell(x[i], y[i], z[i]));
    }
    canvases[slot].dots(dots);
    drawn[slot].push(...dots);
    const { count: n, sum, square } = tallies[slot],
      mean = sum / n;
    figures.sampled = Object.assign(figures.sampled ?? {}, {
      [slot]: { mean, error: Math.sqrt(Math.max(0, square / n - mean * mean) / n), n },
    });
    document.querySelector(`[data-total="${slot}"]`).textContent =
      `albedo ${withError(figures.maps[slot].total, figures.maps[slot].error)}; ${n} samples ${withError(mean, figures.sampled[slot].error)}`;
  }
}

const MOST_SAMPLES = 4096;
function animate() {
  if (state.samples && tallies[0]?.count < MOST_SAMPLES) fall(isReduced.matches ? MOST_SAMPLES : 64);
  stepTuft();
  requestAnimationFrame(animate);
}

/// Takes a state that came from elsewhere: a link, or a step back.
function restore(found) {
  if (found) state = found;
  build();
  changed();
}

/// Drags and arrow keys, as changes of two numbers.
function movable(element, drag, key) {
  element.addEventListener('pointerdown', event => {
    if (event.button) return;
    element.setPointerCapture(event.pointerId);
    let last = event;
    drag(event, event, element.getBoundingClientRect());
    const moved = next => {
      drag(next, last, element.getBoundingClientRect());
      last = next;
    };
    element.addEventListener('pointermove', moved);
    for (const end of ['pointerup', 'pointercancel'])
      element.addEventListener(
        end,
        () => {
          element.removeEventListener('pointermove', moved);
          commit();
        },
        { once: true },
      );
  });
  element.addEventListener('keydown', event => {
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!by) return;
    event.preventDefault();
    key(by.map(x => x * (event.shiftKey ? 10 : 1)));
    commit();
  });
}

function listen() {
  canvases.forEach(({ context: { canvas } }) =>
    movable(
      canvas,
      (event, _, box) => {
        state.cut.phi = +(360 * Math.max(0, Math.min(1, (event.clientX - box.left) / box.width)) - 180).toFixed(1);
        state.cut.theta = +(90 - 180 * Math.max(0, Math.min(1, (event.clientY - box.top) / box.height))).toFixed(1);
        build();
        changed();
      },
      ([x, y]) => {
        state.cut.phi = Math.max(-180, Math.min(180, state.cut.phi + x));
        state.cut.theta = Math.max(-90, Math.min(90, state.cut.theta + y));
        build();
        changed();
      },
    ),
  );
  const turn = (x, y) => {
    state.turn = dragged(state.turn, [x, y], STATE.turn);
    drawSurfaces($('surface'), maps, peakOf(), state.turn);
  };
  movable(
    $('surface'),
    (event, last) => turn((event.clientX - last.clientX) * 0.01, (event.clientY - last.clientY) * 0.01),
    ([x, y]) => turn(x * 0.1, y * 0.1),
  );
  $('undo').addEventListener('click', () => move(past, future) && restore());
  $('redo').addEventListener('click', () => move(future, past) && restore());
  $('reset').addEventListener('click', () => {
    restore(initialState());
    commit();
  });
  $('copy-link').addEventListener('click', () => {
    commit();
    copy(location.href, $('copy-link'));
  });
  $('numbers').addEventListener('toggle', texts);
  addEventListener('keydown', event => {
    if (
      !(event.ctrlKey || event.metaKey) ||
      event.key.toLowerCase() !== 'z' ||
      event.target.matches('textarea, input[type=number]')
    )
      return;
    event.preventDefault();
    $(event.shiftKey ? 'redo' : 'undo').click();
  });
  addEventListener('hashchange', () => {
    const found = readLink(location.hash);
    restore(found.state);
    notice(found.refusal);
    commit();
  });
  let width = innerWidth;
  addEventListener('resize', () => {
    if (innerWidth !== width) {
      width = innerWidth;
      schedule();
    }
  });
  for (const query of ['(prefers-color-scheme: dark)', '(prefers-contrast: more)'])
    matchMedia(query).addEventListener('change', () => {
      readColors();
      schedule();
    });
}

/// For the console: shows a material as A, from a view, with a cut.
function show(material, view, cut) {
  Object.assign(state, { linked: false, view, cut });
  state.materials[0] = structuredClone(material);
  restore();
}

/// For the console: time of one map in milliseconds, evaluated, measured and painted.
function timeMap(slot) {
  const start = performance.now();
  drawMap(slot);
  canvases[slot].paint(maps[slot], colorTable(peakOf()));
  return performance.now() - start;
}

function frames() {
  for (const frame of document.querySelectorAll('.frame')) {
    for (const phi of [-180, -90, 0, 90, 180])
      frame.append(
        make(
          'i',
          { style: `top: calc(100% + 4px); left: ${(phi / 360 + 0.5) * 100}%; transform: translateX(-50%)` },
          minus(`${phi}°`),
        ),
      );
    for (const theta of [90, 45, 0, -45, -90])
      frame.append(
        make(
          'i',
          { style: `right: calc(100% + 4px); top: ${(0.5 - theta / 180) * 100}%; transform: translateY(-50%)` },
          minus(`${theta}°`),
        ),
      );
  }
}

async function start() {
  try {
    kernel = await Kernel.load('hairis.wasm');
  } catch (error) {
    refuse(
      `The module did not start: ${error.message}. The page needs WebAssembly with SIMD, as browsers have it since 2023.`,
    );
    return;
  }
  MAP.write(kernel.maps[0]);
  MAP.write(kernel.maps[1]);
  canvases = [0, 1, 2].map(slot => new MapCanvas($(`map-${slot}`)));
  readColors();
  frames();
  const found = readLink(location.hash);
  state = found.state;
  notice(found.refusal);
  buildTuft();
  build();
  changed();
  past = [JSON.stringify(state)];
  listen();
  requestAnimationFrame(animate);
  globalThis.hairis = {
    kernel,
    figures,
    request,
    readLink,
    show,
    timeMap,
    tuft,
    get state() {
      return state;
    },
  };
  $('about').textContent =
    'θ is the inclination to the normal plane of the fibre, φ the azimuth around it; the viewer is at φ 0°. Angles, lights and figures are those of the commands hairis eval and hairis compare. Nothing is loaded from elsewhere, and nothing leaves this page.';
}

start();
