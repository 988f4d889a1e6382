// Controls: every field of a model as the module describes it.

const $ = id => document.getElementById(id);
let unique = 0;

/// An element with attributes and children.
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name.startsWith('aria-')) element.setAttribute(name, value);
    else if (value === true) element.setAttribute(name, '');
    else if (value !== false && value !== undefined && value !== null) element.setAttribute(name, value);
  }
  element.append(...children.filter(child => child !== null));
  return element;
}

/// A slider with its number: `get` and `set` in the unit that is shown.
function slider({ label, unit = '', title, range: [least, most], log = false, limits, get, set }) {
  const id = `control-${unique++}`, steps = 1000;
  let [lo, hi] = [Math.min(least, get()), Math.max(most, get())];
  if (log && !(lo > 0)) lo = least > 0 ? least : hi * 1e-4;
  const place = value => Math.round(steps * (log ? Math.log(Math.max(value, lo) / lo) / Math.log(hi / lo) : (value - lo) / (hi - lo)));
  const value = at => +(log ? lo * (hi / lo) ** (at / steps) : lo + (hi - lo) * at / steps).toPrecision(4);
  const shown = () => +get().toPrecision(5);
  const range = make('input', { type: 'range', id, min: 0, max: steps, value: place(get()), title });
  const number = make('input', { type: 'number', step: 'any', value: shown(), 'aria-label': `${label}${unit && `, ${unit}`}`, title: limits });
  const announce = () => range.setAttribute('aria-valuetext', `${shown()}${unit && ` ${unit}`}`);
  announce();
  const take = (input, next) => {
    const refused = Number.isFinite(next) ? set(next) : `${label} must be a number, got nothing`;
    number.setAttribute('aria-invalid', Boolean(refused));
    refuse(refused);
    if (refused) return;
    if (input !== number) number.value = shown();
    if (input !== range) range.value = place(get());
    announce();
  };
  range.addEventListener('input', () => take(range, value(+range.value)));
  number.addEventListener('input', () => take(number, number.valueAsNumber));
  for (const input of [range, number]) input.addEventListener('change', commit);
  return make('div', { class: 'row' }, make('label', { for: id, title }, label, unit && make('small', {}, ` ${unit}`)), range, number);
}

/// A colour: a picker of its hue, a slider of its largest channel, and the three numbers.
function colorRow({ label, title, most, get, set }) {
  const id = `control-${unique++}`;
  const scale = () => Math.max(...get());
  const hex = () => {
    const by = Math.max(1e-9, scale());
    return `#${get().map(x => Math.round(255 * toSrgb(Math.min(1, x / by))).toString(16).padStart(2, '0')).join('')}`;
  };
  const picker = make('input', { type: 'color', id, value: hex(), title: `${label}: hue, at the brightness of the slider` });
  const steps = 1000, high = Math.max(most, scale());
  const range = make('input', { type: 'range', min: 0, max: steps, value: Math.round(steps * Math.sqrt(scale() / high)), 'aria-label': `${label}, largest channel` });
  const numbers = [0, 1, 2].map(c => make('input', { type: 'number', step: 'any', value: +get()[c].toPrecision(5), 'aria-label': `${label}, ${['red', 'green', 'blue'][c]}` }));
  const take = (from, next) => {
    const refused = next.every(Number.isFinite) ? set(next) : `${label} must be three numbers`;
    numbers.forEach(number => number.setAttribute('aria-invalid', Boolean(refused)));
    refuse(refused);
    if (refused) return;
    if (from !== numbers) numbers.forEach((number, c) => { number.value = +get()[c].toPrecision(5); });
    if (from !== picker) picker.value = hex();
    if (from !== range) range.value = Math.round(steps * Math.sqrt(scale() / high));
  };
  // The hue that a slider at 0 leaves behind.
  let hue = null;
  picker.addEventListener('input', () => {
    const linear = [1, 3, 5].map(at => toLinear(parseInt(picker.value.slice(at, at + 2), 16) / 255));
    const by = (scale() || most / 2) / Math.max(1e-9, ...linear);
    take(picker, linear.map(x => +(x * by).toPrecision(4)));
  });
  range.addEventListener('input', () => {
    if (scale() > 0) hue = get().map(x => x / scale());
    const to = high * (range.value / steps) ** 2;
    take(range, (hue ?? [1, 1, 1]).map(x => +(x * to).toPrecision(4)));
  });
  numbers.forEach(number => number.addEventListener('input', () => take(numbers, numbers.map(one => one.valueAsNumber))));
  for (const input of [picker, range, ...numbers]) input.addEventListener('change', commit);
  return make('div', { class: 'row rgb' }, make('label', { for: id, title }, label), make('div', { class: 'paint', style: 'grid-column: 2 / 4' }, picker, range), make('div', { class: 'channels' }, ...numbers));
}

function choice(label, options, current, set) {
  const id = `control-${unique++}`;
  const select = make('select', { id }, ...options.map(({ value, text }) => make('option', { value, selected: value === current }, text ?? value)));
  select.addEventListener('change', () => set(select.value));
  return make('div', { class: 'row plain' }, make('label', { for: id }, label), select);
}

function check(label, current, set) {
  const box = make('input', { type: 'checkbox' });
  box.checked = current;
  box.addEventListener('change', () => { set(box.checked); changed(); commit(); });
  return make('label', {}, box, label);
}

/// A row of buttons of which one is pressed.
function buttons(label, options, current, set) {
  return make('div', { class: 'bar', role: 'group', 'aria-label': label }, ...options.map(([value, text]) =>
    make('button', { type: 'button', 'aria-pressed': value === current, onclick: () => { set(value); build(); changed(); commit(); } }, text)));
}

/// Range of a field's slider: that of random materials, widened; within what is accepted.
function sliderRange({ range: [least, most], draw, log }) {
  if (!draw) return most < 1e6 ? [least, most] : [0, 3];
  const [lo, hi] = log ? [draw[0] / 4, draw[1] * 4] : [draw[0] - (draw[1] - draw[0]) / 2, draw[1] + (draw[1] - draw[0]) / 2];
  return [Math.max(lo, least), Math.min(hi, most)];
}

/// The controls of one field.
function fieldRows(field, material) {
  const { values } = material, unit = field.unit === 'rad' ? '°' : '', by = unit ? RAD : 1;
  const put = value => {
    const before = values[field.name];
    values[field.name] = value;
    const refused = changed();
    if (refused) values[field.name] = before;
    return refused;
  };
  if (field.kind === 'word')
    return [choice(field.name, field.words.map(value => ({ value })), values[field.name] ?? field.words[0], value => { put(value); commit(); })];
  const [least, most] = field.range.map(x => x / by);
  const limits = `${+least.toPrecision(3)} to ${most > 1e30 ? 'any size' : +most.toPrecision(4)}${unit}`;
  if (field.kind === 'rgb')
    return [colorRow({ label: field.name, title: field.doc, most: Math.min(field.range[1], field.log ? field.draw[1] : field.draw ? field.draw[1] * 2 : 1), get: () => values[field.name], set: put })];
  const range = sliderRange(field).map(x => x / by), several = field.kind === 'numbers';
  return (several ? field.words : ['']).map((word, place) => slider({
    label: several ? `${field.name} ${word}` : field.name, unit, title: field.doc, range, log: field.log, limits,
    get: () => (several ? values[field.name][place] : values[field.name]) / by,
    set: shown => put(several ? values[field.name].with(place, shortest(shown * by)) : shortest(shown * by)),
  }));
}

/// The controls of a material: its fields, of which some stand for others, or an artist's.
function materialRows(material) {
  const model = kernel.model(material.model);
  if (material.artist) return artistRows(material);
  return model.fields.flatMap(field => {
    const group = model.fields.filter(other => (other.instead_of ?? other.name) === (field.instead_of ?? field.name));
    if (group.length === 1) {
      if (material.values[field.name] === undefined) material.values[field.name] = structuredClone(Object.values(model.presets)[0][field.name]);
      return fieldRows(field, material);
    }
    if (field !== group[0]) return [];
    const given = group.find(other => material.values[other.name] !== undefined) ?? group[0];
    const select = choice(`${group[0].name} by`, group.map(other => ({ value: other.name })), given.name, name => {
      replace(material, model, given, group.find(other => other.name === name));
      build(); changed(); commit();
    });
    return [select, ...fieldRows(given, material)];
  });
}

/// Gives one field of a group in place of another: what the module has made of it where it can be, else the middle of its range.
function replace(material, model, given, next) {
  const effective = kernel.setMaterial(0, material) ? {} : kernel.readValues(model);
  delete material.values[given.name];
  const most = Math.min(1, next.range[1]) / 2, width = widthOf(next);
  material.values[next.name] = effective[next.name] ?? (width > 1 ? Array(width).fill(most) : most);
}

function artistRows(material) {
  let group = '';
  return kernel.artist.flatMap(control => {
    const { artist } = material, [part, name] = control.name.split('.');
    const put = value => {
      const before = artist[control.name];
      artist[control.name] = value;
      const refused = changed();
      if (refused) artist[control.name] = before;
      return refused;
    };
    const title = group === part ? [] : [make('p', { class: 'title' }, part[0].toUpperCase() + part.slice(1))];
    group = part;
    const label = name.replace('_deg', '').replaceAll('_', ' ');
    return [...title, control.kind === 'rgb'
      ? colorRow({ label, title: control.name, most: 1, get: () => artist[control.name], set: put })
      : slider({ label, unit: control.unit && '°', title: control.name, range: control.range, get: () => artist[control.name], set: put })];
  });
}

function refuse(text) { $('refusal').textContent = text ?? ''; }
function notice(text) { $('notice').textContent = text ?? ''; }
const fill = (parent, ...children) => parent.replaceChildren(...children.filter(Boolean));

/// Every control anew.
function build() {
  buildTuftControls();
  const legend = (text, small) => make('legend', {}, text, small ? make('small', {}, ` ${small}`) : null);
  const models = [0, 1].map(slot => kernel.model(state.materials[slot].model)), near = models.some(model => model.near_field);
  const set = (of, name) => value => { state[of][name] = value; return changed(); };
  const lobes = models[0].lobes.length >= models[1].lobes.length ? models[0].lobes : models[1].lobes;
  fill($('view'), legend('View'),
    slider({ label: 'viewer θₒ', unit: '°', title: 'Inclination of the viewer to the normal plane', range: [-89, 89], limits: '−90 to 90°', get: () => state.view.theta, set: value => Math.abs(value) <= 90 ? set('view', 'theta')(value) : `viewer θₒ must be in [−90, 90]°, got ${value}` }),
    near && slider({ label: 'offset h', title: 'Offset of the hit across the fibre', range: [-1, 1], limits: '−1 to 1', get: () => state.view.h, set: value => Math.abs(value) <= 1 ? set('view', 'h')(value) : `h must be in [−1, 1], got ${value}` }),
    slider({ label: 'cut at θᵢ', unit: '°', title: 'Inclination of the plot around the fibre', range: [-90, 90], limits: '−90 to 90°', get: () => state.cut.theta, set: value => Math.abs(value) <= 90 ? set('cut', 'theta')(value) : `cut θᵢ must be in [−90, 90]°, got ${value}` }),
    slider({ label: 'cut at φᵢ', unit: '°', title: 'Azimuth of the plot along the fibre', range: [-180, 180], limits: '−180 to 180°', get: () => state.cut.phi, set: value => Math.abs(value) <= 180 ? set('cut', 'phi')(value) : `cut φᵢ must be in [−180, 180]°, got ${value}` }),
    make('div', { class: 'checks' },
      ...lobes.map((name, lobe) => check(name, Boolean(state.lobes >> lobe & 1), on => { state.lobes = on ? state.lobes | 1 << lobe : state.lobes & ~(1 << lobe); }))));
  fill($('show'),
    buttons('Maps show', [['value', 'S cos θ'], ['color', 'Colour'], ['pdf', 'Sampling density']], state.show, value => { state.show = value; }),
    buttons('Scale', [['log', 'Log'], ['linear', 'Linear']], state.scale, value => { state.scale = value; }),
    make('span', { class: 'checks' }, check('samples', state.samples, on => { state.samples = on; })));
  const slot = isLinked() ? 0 : state.tab, material = edited(), model = kernel.model(material.model);
  const card = $('material');
  card.className = `card ${isLinked() ? '' : slot ? 'slot-b' : 'slot-a'}`;
  const presets = Object.keys(model.presets);
  const current = presets.find(name => !material.artist && isSame(model.presets[name], material.values));
  fill(card, legend('Materials'),
    ...[0, 1].map(which => {
      const own = state.materials[which], of = kernel.model(own.model);
      const row = make('div', { class: which ? 'slot-b' : 'slot-a' }, choice(make('span', { class: 'chip' }, `${'AB'[which]}`), kernel.models.map(({ name }) => ({ value: name })), own.model, name => {
        const values = isLinked() ? structuredClone(state.materials[0]) : null;
        state.materials[which] = newMaterial(kernel.model(name));
        if (values && !which) state.materials[1] = { ...state.materials[1], values: values.values, artist: values.artist };
        else if (values && isSame(kernel.model(name).fields, kernel.model(values.model).fields)) Object.assign(state.materials[which], { values: values.values, artist: values.artist });
        state.lobes = 15;
        build(); changed(); commit();
      }));
      if (of.entries.length > 1)
        row.append(choice(`${of.choice} ${'AB'[which]}`, of.entries.map(({ word }) => ({ value: word })), own.word, word => { own.word = word; changed(); commit(); }));
      return row;
    }),
    haveSameFields() ? make('div', { class: 'checks' }, check('same parameters', state.linked, on => {
      if (!on) Object.assign(state.materials[1], structuredClone({ values: state.materials[0].values, artist: state.materials[0].artist }));
      state.linked = on;
      queueMicrotask(build);
    })) : null,
    isLinked() ? null : buttons('Edit', [[0, `Edit A: ${models[0].name}`], [1, `Edit B: ${models[1].name}`]], state.tab, tab => { state.tab = tab; }),
    choice('preset', [...(current ? [] : [{ value: '', text: 'edited' }]), ...presets.map(value => ({ value }))], current ?? '', name => {
      if (!name) return;
      material.values = structuredClone(model.presets[name]);
      if (material.artist) { kernel.setMaterial(slot, { ...material, artist: null }); material.artist = kernel.toArtist(slot); }
      build(); changed(); commit();
    }),
    model.artist ? buttons('Terms', [[false, 'Parameters'], [true, 'Artist’s controls']], Boolean(material.artist), wanted => {
      if (wanted && !material.artist) { kernel.setMaterial(slot, material); material.artist = kernel.toArtist(slot); }
      if (!wanted && material.artist) { material.values = fieldsOf(material, slot); material.artist = null; }
    }) : null,
    ...materialRows(material));
}
