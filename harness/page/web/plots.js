// Pictures on canvases: maps, plots with axes, and surfaces that turn.

const VIRIDIS = [0x440154, 0x472c7a, 0x3b518b, 0x2c718e, 0x21908d, 0x27ad81, 0x5cc863, 0xaadc32, 0xfde725];
const DECADES = 4;

const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
let colors = {};

function readColors() {
  const names = ['ink', 'faint', 'line', 'panel', 'a', 'b', 'mark'];
  colors = Object.fromEntries(names.map(name => [name, css(`--${name}`)]));
  colors.slots = [colors.a, colors.b];
}

/// A colour of a scale of hexadecimal colours, as bytes of little-endian RGBA.
function onScale(scale, t) {
  const at = Math.max(0, Math.min(1, t)) * (scale.length - 1),
    low = Math.min(scale.length - 2, Math.floor(at)),
    part = at - low;
  const channel = shift =>
    Math.round(((scale[low] >> shift) & 255) * (1 - part) + ((scale[low + 1] >> shift) & 255) * part);
  return ((255 << 24) | (channel(0) << 16) | (channel(8) << 8) | channel(16)) >>> 0;
}

/// Blue below, white, vermillion above: told apart by people who see colours differently.
const DIVERGING = [0x053a66, 0x0072b2, 0x7fb9dc, 0xf7f7f7, 0xf0a883, 0xd55e00, 0x6b2a00];

const STEPS = 1024;
const steps = scale => Uint32Array.from({ length: STEPS }, (_, i) => onScale(scale, i / (STEPS - 1)));
const VIRIDIS_STEPS = steps(VIRIDIS),
  DIVERGING_STEPS = steps(DIVERGING);

/// Numbers of which the upper half of the bits counts up: with them a map needs no logarithm per cell.
const UPPER = new Float32Array(Uint32Array.from({ length: 65536 }, (_, i) => (i << 16) | 0x8000).buffer);

/// Entries by the upper half of a number's bits; the first half are numbers above 0.
function table(of, entries = new Uint32Array(65536), count = 65536) {
  for (let i = 0; i < count; i++) entries[i] = of(UPPER[i]);
  return entries;
}

/// Place of a value on the scale from 0 to 1.
const position = (value, peak, scale) =>
  scale === 'log' ? 1 + Math.log10(Math.max(value, 1e-30) / peak) / DECADES : value / peak;

/// Place of a difference on the scale from -1 to 1.
const signedPosition = (value, peak) => Math.sign(value) * Math.sqrt(Math.abs(value) / peak);

class MapCanvas {
  constructor(canvas) {
    this.context = canvas.getContext('2d', { alpha: false });
    canvas.width = WIDTH;
    canvas.height = HEIGHT;
    this.image = this.context.createImageData(WIDTH, HEIGHT);
    this.pixels = new Uint32Array(this.image.data.buffer);
  }

  /// Colours of a table, by the upper bits of each number.
  paint(values, colorsOf) {
    const bits = new Uint32Array(values.buffer, values.byteOffset, this.pixels.length),
      { pixels } = this;
    for (let at = 0; at < pixels.length; at++) pixels[at] = colorsOf[bits[at] >>> 16];
    this.context.putImageData(this.image, 0, 0);
  }

  /// Light as a camera sees it: red, green and blue of S cos theta.
  paintColor([, , , r, g, b], tone) {
    const [red, green, blue] = [r, g, b].map(
      column => new Uint32Array(column.buffer, column.byteOffset, this.pixels.length),
    );
    for (let row = 0, at = 0; row < HEIGHT; row++) {
      const cosine = tone.rows[row];
      for (let column = 0; column < WIDTH; column++, at++)
        this.pixels[at] =
          0xff000000 | (cosine[blue[at] >>> 16] << 16) | (cosine[green[at] >>> 16] << 8) | cosine[red[at] >>> 16];
    }
    this.context.putImageData(this.image, 0, 0);
  }

  /// Cross at the cut, and a ring at the viewer.
  mark(cut, theta) {
    const { context } = this,
      x = (cut.phi / 360 + 0.5) * WIDTH,
      y = (0.5 - cut.theta / 180) * HEIGHT;
    context.lineWidth = 1;
    for (const [style, shift] of [
      ['#000a', 0.5],
      ['#fffc', -0.5],
    ]) {
      context.strokeStyle = style;
      context.beginPath();
      context.moveTo(0, y + shift);
      context.lineTo(WIDTH, y + shift);
      context.moveTo(x + shift, 0);
      context.lineTo(x + shift, HEIGHT);
      context.stroke();
    }
    for (const [style, width] of [
      ['#000', 4],
      ['#fff', 2],
    ]) {
      context.strokeStyle = style;
      context.lineWidth = width;
      context.beginPath();
      context.arc(WIDTH / 2, (0.5 - theta / 180) * HEIGHT, 6, 0, 7);
      context.stroke();
    }
  }

  dots(samples) {
    const { context } = this;
    for (const [style, size] of [
      ['#000', 3],
      ['#fff', 2],
    ]) {
      context.fillStyle = style;
      for (const [x, y] of samples) context.fillRect(x - size / 2, y - size / 2, size, size);
    }
  }
}

/// A canvas in pixels of the device.
function fitted(canvas, height) {
  const ratio = Math.min(3, devicePixelRatio || 1),
    width = canvas.clientWidth || 300;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) {
    canvas.width = w;
    canvas.height = h;
  }
  canvas.style.height = `${height}px`;
  const context = canvas.getContext('2d');
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = '11px system-ui, sans-serif';
  return { context, width, height };
}

const tidy = value =>
  value === 0
    ? '0'
    : Math.abs(value) >= 1e4 || Math.abs(value) < 1e-3
      ? value.toExponential(0).replace('e+', 'e')
      : String(+value.toPrecision(3));

/// Steps of 1, 2 or 5 that cut a range into at most so many parts.
function niceStep(range, most) {
  const raw = range / most,
    power = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 5, 10].map(by => by * power).find(step => step >= raw);
}

/// A plot of lines over an axis in degrees.
function plot(canvas, { lines, range, ticks, label, unit, log, marker, top, guides = [] }) {
  const { context, width, height } = fitted(canvas, 200);
  const [left, right, upper, lower] = [44, 16, 10, 34],
    w = width - left - right,
    h = height - upper - lower;
  const peak = top ?? Math.max(1e-12, ...lines.flatMap(({ y }) => Array.from(y)));
  const least = log ? peak * 10 ** -DECADES : 0;
  const px = x => left + ((x - range[0]) / (range[1] - range[0])) * w;
  const py = y => upper + h * (1 - Math.max(0, Math.min(1.02, log ? position(y, peak, 'log') : y / peak)));
  context.strokeStyle = colors.line;
  context.fillStyle = colors.faint;
  context.lineWidth = 1;
  context.textAlign = 'center';
  for (let x = Math.ceil(range[0] / ticks) * ticks; x <= range[1]; x += ticks) {
    context.beginPath();
    context.moveTo(Math.round(px(x)) + 0.5, upper);
    context.lineTo(Math.round(px(x)) + 0.5, upper + h);
    context.stroke();
    context.fillText(`${x}°`.replace('-', '−'), px(x), upper + h + 14);
  }
  context.textAlign = 'right';
  const values = [];
  if (log) for (let power = Math.ceil(Math.log10(least)); power <= Math.log10(peak); power++) values.push(10 ** power);
  else for (let y = 0, step = niceStep(peak, 5); y <= peak * 1.001; y += step) values.push(y);
  for (const y of values) {
    context.beginPath();
    context.moveTo(left, Math.round(py(y)) + 0.5);
    context.lineTo(left + w, Math.round(py(y)) + 0.5);
    context.stroke();
    context.fillText(tidy(y), left - 5, py(y) + 4);
  }
  context.textAlign = 'left';
  context.fillText(unit, left, height - 4);
  context.textAlign = 'right';
  context.fillText(label, left + w, height - 4);
  for (const y of guides)
    line(
      context,
      [
        [left, py(y)],
        [left + w, py(y)],
      ],
      colors.ink,
      1,
      [2, 3],
    );
  if (marker !== undefined)
    line(
      context,
      [
        [px(marker), upper],
        [px(marker), upper + h],
      ],
      colors.mark,
      1,
      [4, 3],
    );
  context.save();
  context.beginPath();
  context.rect(left, upper - 2, w, h + 4);
  context.clip();
  for (const { x, y, color, dash = [], weight = 1.5 } of lines)
    line(
      context,
      Array.from(y, (value, at) => [px(x[at]), py(value)]),
      color,
      weight,
      dash,
    );
  context.restore();
}

function line(context, points, color, weight, dash) {
  context.strokeStyle = color;
  context.lineWidth = weight;
  context.setLineDash(dash);
  context.beginPath();
  points.forEach(([x, y], at) => (at ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
  context.setLineDash([]);
}

/// A scale of colours with its ticks.
function drawScale(canvas, colorAt, ticks) {
  const { context, width } = fitted(canvas, 26);
  for (let x = 0; x < width; x++) {
    const color = colorAt(x / (width - 1));
    context.fillStyle = `rgb(${color & 255} ${(color >> 8) & 255} ${(color >> 16) & 255})`;
    context.fillRect(x, 0, 1.5, 9);
  }
  context.fillStyle = colors.faint;
  let end = -1e9;
  for (const { at, text } of ticks) {
    const half = context.measureText(text).width / 2,
      x = Math.max(half, Math.min(width - half, at * width));
    if (x - half < end + 6) continue;
    context.textAlign = 'center';
    context.fillText(text, x, 21);
    end = x + half;
  }
}

const ACROSS = 96,
  DOWN = 48;

/// Surfaces whose distance from the centre is the square root of S cos theta, turned by two angles.
function drawSurfaces(canvas, maps, peak, [turn, tilt]) {
  const { context, width, height } = fitted(canvas, 240);
  const size = Math.min(width / 4.4, height / 2.15),
    [ct, st, ci, si] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
  // The fibre, along the first axis, stands upright.
  const turned = (u, v, w) => [v * ct + w * st, u * ci - (w * ct - v * st) * si, u * si + (w * ct - v * st) * ci];
  maps.forEach((map, slot) => {
    const middle = [width * (0.25 + 0.5 * slot), height / 2],
      points = [];
    const axis = [
      [-1.05, 0, 0],
      [1.05, 0, 0],
    ].map(([u]) => turned(u, 0, 0));
    line(
      context,
      axis.map(([x, y]) => [middle[0] + x * size, middle[1] - y * size]),
      colors.faint,
      2,
      [],
    );
    const view = turned(...wo(state.view.theta));
    line(
      context,
      [
        [middle[0], middle[1]],
        [middle[0] + view[0] * size, middle[1] - view[1] * size],
      ],
      colors.mark,
      1,
      [4, 3],
    );
    for (let i = 0; i <= DOWN; i++)
      for (let j = 0; j < ACROSS; j++) {
        const theta = 90 - (180 * i) / DOWN,
          phi = (360 * j) / ACROSS - 180;
        const row = Math.min(HEIGHT - 1, Math.floor((i * HEIGHT) / DOWN)),
          column = Math.floor((j * WIDTH) / ACROSS);
        const radius = Math.sqrt(map[row * WIDTH + column] / peak);
        points.push(turned(...direction(theta, phi).map(x => x * radius)));
      }
    const quads = [];
    for (let i = 0; i < DOWN; i++)
      for (let j = 0; j < ACROSS; j++) {
        const at = [
          i * ACROSS + j,
          i * ACROSS + ((j + 1) % ACROSS),
          (i + 1) * ACROSS + ((j + 1) % ACROSS),
          (i + 1) * ACROSS + j,
        ].map(k => points[k]);
        quads.push([at[0][2] + at[2][2], at]);
      }
    quads.sort(([a], [b]) => a - b);
    const [red, green, blue] = rgb(colors.slots[slot]);
    for (const [, [p, q, r, s]] of quads) {
      const [ax, ay, az] = [0, 1, 2].map(k => r[k] - p[k]),
        [bx, by, bz] = [0, 1, 2].map(k => s[k] - q[k]);
      const n = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx],
        length = Math.hypot(...n);
      if (length < 1e-9) continue;
      const shade = 0.45 + (0.55 * Math.abs(n[2] * 0.8 + n[1] * 0.5 + n[0] * 0.33)) / length;
      const fill = `rgb(${(red * shade) | 0} ${(green * shade) | 0} ${(blue * shade) | 0})`;
      context.fillStyle = context.strokeStyle = fill;
      context.lineWidth = 0.6;
      context.beginPath();
      [p, q, r, s].forEach(([x, y], k) => context[k ? 'lineTo' : 'moveTo'](middle[0] + x * size, middle[1] - y * size));
      context.fill();
      context.stroke();
    }
  });
}

function rgb(hex) {
  const value = parseInt(hex.slice(1), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
}
