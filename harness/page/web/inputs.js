// Inputs: sliders with numbers, colours, choices, and elements in general.

const $ = id => document.getElementById(id);
let unique = 0;

const minus = text => text.replace('-', '−');
const toSrgb = x => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const toLinear = x => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);

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
  const id = `control-${unique++}`,
    steps = 1000;
  let [lo, hi] = [Math.min(least, get()), Math.max(most, get())];
  if (log && !(lo > 0)) lo = least > 0 ? least : hi * 1e-4;
  const place = value =>
    Math.round(steps * (log ? Math.log(Math.max(value, lo) / lo) / Math.log(hi / lo) : (value - lo) / (hi - lo)));
  const value = at => +(log ? lo * (hi / lo) ** (at / steps) : lo + ((hi - lo) * at) / steps).toPrecision(4);
  const shown = () => +get().toPrecision(5);
  const range = make('input', { type: 'range', id, min: 0, max: steps, value: place(get()), title });
  const number = make('input', {
    type: 'number',
    step: 'any',
    value: shown(),
    'aria-label': `${label}${unit && `, ${unit}`}`,
    title: limits,
  });
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
  return make(
    'div',
    { class: 'row' },
    make('label', { for: id, title }, label, unit && make('small', {}, ` ${unit}`)),
    range,
    number,
  );
}

/// The limits of a slider by the description of its number, which refuses all others; `set` takes the rest.
const limited = ({ least, most, rule, allows }, label, set) => ({
  limits: minus(`${least} to ${most}`),
  set: value => (allows(value) ? set(value) : `${label} must be ${rule}, got ${value}`),
});

/// A colour: a picker of its hue, a slider of its largest channel, and the three numbers.
function colorRow({ label, title, most, get, set }) {
  const id = `control-${unique++}`;
  const scale = () => Math.max(...get());
  const hex = () => {
    const by = Math.max(1e-9, scale());
    return `#${get()
      .map(x =>
        Math.round(255 * toSrgb(Math.min(1, x / by)))
          .toString(16)
          .padStart(2, '0'),
      )
      .join('')}`;
  };
  const picker = make('input', {
    type: 'color',
    id,
    value: hex(),
    title: `${label}: hue, at the brightness of the slider`,
  });
  const steps = 1000,
    high = Math.max(most, scale());
  const range = make('input', {
    type: 'range',
    min: 0,
    max: steps,
    value: Math.round(steps * Math.sqrt(scale() / high)),
    'aria-label': `${label}, largest channel`,
  });
  const numbers = [0, 1, 2].map(c =>
    make('input', {
      type: 'number',
      step: 'any',
      value: +get()[c].toPrecision(5),
      'aria-label': `${label}, ${['red', 'green', 'blue'][c]}`,
    }),
  );
  const take = (from, next) => {
    const refused = next.every(Number.isFinite) ? set(next) : `${label} must be three numbers`;
    numbers.forEach(number => number.setAttribute('aria-invalid', Boolean(refused)));
    refuse(refused);
    if (refused) return;
    if (from !== numbers)
      numbers.forEach((number, c) => {
        number.value = +get()[c].toPrecision(5);
      });
    if (from !== picker) picker.value = hex();
    if (from !== range) range.value = Math.round(steps * Math.sqrt(scale() / high));
  };
  // The hue that a slider at 0 leaves behind.
  let hue = null;
  picker.addEventListener('input', () => {
    const linear = [1, 3, 5].map(at => toLinear(parseInt(picker.value.slice(at, at + 2), 16) / 255));
    const by = (scale() || most / 2) / Math.max(1e-9, ...linear);
    take(
      picker,
      linear.map(x => +(x * by).toPrecision(4)),
    );
  });
  range.addEventListener('input', () => {
    if (scale() > 0) hue = get().map(x => x / scale());
    const to = high * (range.value / steps) ** 2;
    take(
      range,
      (hue ?? [1, 1, 1]).map(x => +(x * to).toPrecision(4)),
    );
  });
  numbers.forEach(number =>
    number.addEventListener('input', () =>
      take(
        numbers,
        numbers.map(one => one.valueAsNumber),
      ),
    ),
  );
  for (const input of [picker, range, ...numbers]) input.addEventListener('change', commit);
  return make(
    'div',
    { class: 'row rgb' },
    make('label', { for: id, title }, label),
    make('div', { class: 'paint', style: 'grid-column: 2 / 4' }, picker, range),
    make('div', { class: 'channels' }, ...numbers),
  );
}

function choice(label, options, current, set) {
  const id = `control-${unique++}`;
  const select = make(
    'select',
    { id },
    ...options.map(({ value, text }) => make('option', { value, selected: value === current }, text ?? value)),
  );
  select.addEventListener('change', () => set(select.value));
  return make('div', { class: 'row plain' }, make('label', { for: id }, label), select);
}

function check(label, current, set) {
  const box = make('input', { type: 'checkbox' });
  box.checked = current;
  box.addEventListener('change', () => {
    set(box.checked);
    changed();
    commit();
  });
  return make('label', {}, box, label);
}

/// A row of buttons of which one is pressed.
function buttons(label, options, current, set) {
  return make(
    'div',
    { class: 'bar', role: 'group', 'aria-label': label },
    ...options.map(([value, text]) =>
      make(
        'button',
        {
          type: 'button',
          'aria-pressed': value === current,
          onclick: () => {
            set(value);
            build();
            changed();
            commit();
          },
        },
        text,
      ),
    ),
  );
}

function refuse(text) {
  $('refusal').textContent = text ?? '';
}
function notice(text) {
  $('notice').textContent = text ?? '';
}
const fill = (parent, ...children) => parent.replaceChildren(...children.filter(Boolean));
