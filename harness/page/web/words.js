// Words and numbers: captions, tables, the answer, and texts to copy.

const title = name => name.replace(/(^|-)\w/g, letter => letter.toUpperCase());
const titleOf = slot => title(state.materials[slot].model);
const percent = (x, digits = 1) => minus(`${(100 * x).toFixed(digits)}%`);

/// A figure with its error: digits that the error leaves.
function withError(value, error) {
  if (!Number.isFinite(value)) return '–';
  const from = Math.max(error, Math.abs(value) * 5e-4, 1e-12),
    digits = Math.max(0, Math.min(6, 1 - Math.floor(Math.log10(from))));
  return `${value.toFixed(digits)} ± ${Math.max(error, 10 ** -digits).toFixed(digits)}`;
}

/// Captions and the readout.
function describe() {
  for (const slot of [0, 1]) {
    document.querySelectorAll(`[data-name="${slot}"]`).forEach(element => {
      element.textContent = `${'AB'[slot]}: ${titleOf(slot)}`;
    });
    const { total, error } = figures.maps[slot],
      caption = document.querySelector(`[data-total="${slot}"]`);
    caption.textContent = `albedo ${withError(total, error)}`;
    canvases[slot].context.canvas.setAttribute(
      'aria-label',
      `S cos theta of ${titleOf(slot)} over the sphere; arrow keys move the cut`,
    );
  }
  canvases[2].context.canvas.setAttribute('aria-label', 'Difference of both maps; arrow keys move the cut');
  $('difference').textContent = Number.isFinite(figures.difference.l1)
    ? `B − A, L1 ${percent(figures.difference.l1)}`
    : 'B − A';
  const angle = x => minus(`${+x.toFixed(1)}°`);
  $('along-note').textContent = `φᵢ ${angle(state.cut.phi)}`;
  $('around-note').textContent = `θᵢ ${angle(state.cut.theta)}`;
  figures.readout = [0, 1].map(slot => {
    direction(state.cut.theta, state.cut.phi).forEach((x, axis) => {
      kernel.work[axis][0] = x;
    });
    kernel.calls.eval(slot, kernel.entry(state.materials[slot]).model, false, 1);
    const [s, pdf] = [[3, 4, 5].map(column => kernel.work[column][0]), kernel.work[6][0]];
    return { s, pdf };
  });
  const numbers = ({ s, pdf }) => `S ${s.map(x => x.toPrecision(4)).join(' ')}, density ${pdf.toPrecision(4)}`;
  $('readout').textContent =
    `At θᵢ ${angle(state.cut.theta)}, φᵢ ${angle(state.cut.phi)} — A: ${numbers(figures.readout[0])}; B: ${numbers(figures.readout[1])}. The ring marks the viewer, the cross the cut.`;
  const lobes = [0, 1].map(slot => kernel.model(state.materials[slot].model).lobes),
    names = lobes[0].length >= lobes[1].length ? lobes[0] : lobes[1];
  fill(
    $('key'),
    make('b', { class: 'chip slot-a' }, `A: ${titleOf(0)}`),
    make('b', { class: 'chip slot-b' }, `B: ${titleOf(1)}`),
    make('span', {}, 'Each lobe alone:'),
    ...names.map((name, lobe) =>
      (state.lobes >> lobe) & 1 ? make('span', {}, dashSample(DASHES[lobe]), ` ${name}`) : null,
    ),
  );
}

function dashSample(dash) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg'),
    stroke = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  for (const [name, value] of Object.entries({ width: 30, height: 8, 'aria-hidden': true }))
    svg.setAttribute(name, value);
  for (const [name, value] of Object.entries({
    d: 'M0 4H30',
    stroke: 'currentColor',
    'stroke-width': 1.5,
    'stroke-dasharray': dash.join(' '),
  }))
    stroke.setAttribute(name, value);
  svg.append(stroke);
  return svg;
}

function drawVariance() {
  const rows = [
    make(
      'tr',
      {},
      make('th', {}, 'sampler'),
      ...LIGHTS.map(({ name }) => make('th', { style: 'text-align: right', scope: 'col' }, name)),
    ),
  ];
  for (const slot of [0, 1]) {
    const { entries, lights } = figures.variance[slot],
      names = ['uniform', ...entries.map(entry => entry.word || 'its sampler')];
    rows.push(
      make(
        'tr',
        { class: `group ${slot ? 'slot-b' : 'slot-a'}` },
        make('th', { colspan: 1 + LIGHTS.length }, make('span', { class: 'chip' }, `${'AB'[slot]}: ${titleOf(slot)}`)),
      ),
    );
    names.forEach((name, sampler) =>
      rows.push(
        make(
          'tr',
          {},
          make('th', { scope: 'row' }, name),
          ...lights.map((row, light) => {
            const best = Math.min(...row.map(({ value }) => value));
            return make(
              'td',
              { class: row[sampler].value === best ? 'best' : null, 'data-v': `${slot} ${name} ${LIGHTS[light].name}` },
              withError(row[sampler].value, row[sampler].error),
            );
          }),
        ),
      ),
    );
  }
  fill($('variance'), ...rows);
}

/// The figure of the pair, and a sentence that follows from the figures.
function answer() {
  const { l1, error } = figures.difference,
    [a, b] = [titleOf(0), titleOf(1)],
    [of, other] = figures.maps;
  const view = minus(`${+state.view.theta.toFixed(1)}°`),
    ratio = other.total / of.total - 1;
  const sentences = [];
  if (!(of.total > 0 && other.total > 0)) {
    fill(
      $('answer'),
      make('div', { class: 'figure', id: 'l1' }, '–'),
      make('p', { id: 'sentence' }, `Seen from ${view}, ${of.total > 0 ? b : a} reflects no light.`),
    );
    return;
  }
  const light =
    Math.abs(ratio) < 5e-4 ? 'as much light' : `${percent(Math.abs(ratio))} ${ratio > 0 ? 'more' : 'less'} light`;
  sentences.push(
    l1 < 5e-4
      ? `Seen from ${view}, ${b} scatters as ${a} does.`
      : `Seen from ${view}, ${b} differs from ${a} by ${percent(l1)} of the light that ${a} reflects, and returns ${light}.`,
  );
  const v = (slot, word) => {
    const { entries, lights } = figures.variance[slot],
      place = entries.findIndex(entry => entry.word === word) + 1;
    return place ? lights.map(row => row[place].value) : null;
  };
  const [published, tried, matched] = [v(0, 'published'), v(1, 'published'), v(0, 'matched')];
  let verdict = '';
  if (published && tried && matched && state.materials[0].model !== state.materials[1].model) {
    // Lights that a material returns nothing of have no V.
    const saved = tried.map((value, place) =>
        Number.isFinite(value / published[place]) ? 1 - value / published[place] : -Infinity,
      ),
      best = saved.indexOf(Math.max(...saved));
    const rival = 1 - matched[best] / published[best],
      share = x => `${percent(Math.abs(x))} ${x >= 0 ? 'fewer' : 'more'}`;
    sentences.push(
      `With the published sampler ${b} needs ${share(saved[best])} samples under the ${LIGHTS[best].name}${/light|sun$/.test(LIGHTS[best].name) ? '' : ' light'}, where it gains most; the matched sampler of ${a} needs ${share(rival)} and keeps the look.`,
    );
    verdict =
      saved[best] <= 0.1
        ? 'Not here.'
        : rival >= saved[best]
          ? 'Not with a better sampler at hand.'
          : 'For its samples, here it is.';
    sentences.unshift(`Is ${b} worth it in place of ${a}? ${verdict}`);
  } else {
    const [first, second] = [0, 1].map(
      slot =>
        figures.variance[slot].lights[0][
          figures.variance[slot].entries.indexOf(kernel.entry(state.materials[slot])) + 1
        ].value,
    );
    sentences.push(
      `Under the constant light V of one sample is ${first.toPrecision(3)} for ${a} and ${second.toPrecision(3)} for ${b}.`,
    );
  }
  fill(
    $('answer'),
    make(
      'div',
      { class: 'figure', id: 'l1' },
      percent(l1),
      make('small', {}, ` ± ${percent(Math.max(error, 5e-5), 2)} L1`),
    ),
    make('p', { id: 'sentence' }, sentences.join(' ')),
  );
}

/// JSON of both materials, and constants for shaders.
function texts() {
  const box = $('texts');
  if (!$('numbers').open) return;
  fill(
    box,
    ...[0, 1].map(slot => {
      const area = make('textarea', {
        id: `json-${slot}`,
        spellcheck: 'false',
        'aria-label': `Request of hairis eval, material ${'AB'[slot]}`,
      });
      area.value = JSON.stringify(request(slot));
      area.addEventListener('change', () => {
        const refusal = takeRequest(area.value, slot);
        if (refusal) {
          changed();
          refuse(refusal);
          return;
        }
        build();
        changed();
        commit();
      });
      kernel.setMaterial(slot, materialOf(slot));
      const count = kernel.calls.constants(slot),
        constants = Array.from(kernel.work[0].subarray(0, count), shortest);
      const shader = make('textarea', {
        id: `constants-${slot}`,
        readonly: true,
        'aria-label': `Constants for a shader, material ${'AB'[slot]}`,
      });
      shader.value = `[${constants.join(', ')}]`;
      return make(
        'div',
        { class: slot ? 'slot-b' : 'slot-a' },
        make('p', { class: 'title' }, make('span', { class: 'chip' }, `${'AB'[slot]}: ${titleOf(slot)}`)),
        make('p', { class: 'note' }, 'A line for the command hairis eval; an edited line becomes the material.'),
        area,
        make(
          'div',
          { class: 'bar' },
          copyButton('Copy JSON', () => area.value),
          copyButton('Copy numbers', () => shader.value),
        ),
        make(
          'p',
          { class: 'note' },
          `The ${count} constants of the material, as the functions that hairis shader prints take them.`,
        ),
        shader,
      );
    }),
  );
}

function copyButton(text, of) {
  const button = make('button', { type: 'button' }, text);
  button.addEventListener('click', () => copy(of(), button));
  return button;
}

async function copy(text, button) {
  const before = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = 'Copied';
  } catch {
    notice(`The browser refused the clipboard; the text is ${text}`);
  }
  setTimeout(() => {
    button.textContent = before;
  }, 1200);
}
