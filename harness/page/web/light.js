// Light from all around: a map in latitude and longitude, its directions by brightness, and files.

const LONGEST = 512;

class Environment {
  /// `data` is linear red, green and blue by pixel, the top row first; larger maps are averaged down.
  constructor(name, width, height, data) {
    const by = Math.max(1, Math.ceil(width / LONGEST)),
      [w, h] = [Math.max(1, Math.floor(width / by)), Math.max(1, Math.floor(height / by))];
    Object.assign(this, {
      name,
      width: w,
      height: h,
      data: new Float32Array(3 * w * h),
      sums: new Float64Array(w * h + 1),
    });
    for (let y = 0, at = 0; y < h; y++) {
      const area = (Math.cos(Math.PI * ((y + 0.5) / h - 0.5)) * 2 * Math.PI ** 2) / (w * h);
      for (let x = 0; x < w; x++, at++) {
        for (let c = 0; c < 3; c++) {
          let sum = 0;
          for (let i = 0; i < by; i++)
            for (let j = 0; j < by; j++) sum += data[3 * ((y * by + i) * width + x * by + j) + c];
          this.data[3 * at + c] = Number.isFinite(sum) ? Math.max(0, sum) / (by * by) : 0;
        }
        this.sums[at + 1] =
          this.sums[at] + (area * (this.data[3 * at] + this.data[3 * at + 1] + this.data[3 * at + 2])) / 3;
      }
    }
    this.total = this.sums.at(-1);
    if (!(this.total > 0)) throw new Error('it is black');
  }

  /// A direction by brightness, y up, with its radiance over its density.
  sample(s, t, u, turn) {
    const goal = s * this.total;
    let [low, high] = [0, this.sums.length - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.sums[middle] <= goal) low = middle;
      else high = middle;
    }
    const theta = Math.PI * (0.5 - (Math.floor(low / this.width) + t) / this.height),
      phi = 2 * Math.PI * (((low % this.width) + u) / this.width - 0.5) + turn;
    const mean = (this.data[3 * low] + this.data[3 * low + 1] + this.data[3 * low + 2]) / 3;
    return {
      dir: [Math.cos(theta) * Math.sin(phi), Math.sin(theta), -Math.cos(theta) * Math.cos(phi)],
      radiance: [0, 1, 2].map(c => (this.data[3 * low + c] / mean) * this.total),
    };
  }
}

/// A blue sky above a warm ground, with a sun behind the viewer's left and a softer lamp beyond the tuft.
function skyLight() {
  const [w, h] = [128, 64],
    data = new Float32Array(3 * w * h);
  const lamps = [
    [40, -130, 7, [150, 132, 104]],
    [20, 25, 14, [9, 10, 12]],
  ].map(([theta, phi, size, color]) => ({ dir: aim(theta, phi), size: size * RAD, color }));
  for (let y = 0, at = 0; y < h; y++)
    for (let x = 0; x < w; x++, at += 3) {
      const dir = aim(90 - (180 * (y + 0.5)) / h, (360 * (x + 0.5)) / w - 180),
        up = dir[1];
      const base = up > 0 ? [0.28 - 0.15 * up, 0.34 - 0.1 * up, 0.45] : [0.1, 0.085, 0.07];
      for (let c = 0; c < 3; c++)
        data[at + c] =
          base[c] +
          lamps.reduce((sum, lamp) => {
            const angle =
              Math.acos(
                Math.min(
                  1,
                  lamp.dir.reduce((dot, v, i) => dot + v * dir[i], 0),
                ),
              ) / lamp.size;
            return sum + lamp.color[c] * Math.exp(-(angle ** 4));
          }, 0);
    }
  return new Environment('sky', w, h, data);
}

/// The direction at an elevation and an azimuth in degrees, y up.
function aim(theta, phi) {
  const [u, v, w] = direction(theta, phi);
  return [w, u, -v];
}

/// The light of a file of Radiance or OpenEXR; throws an error that says what is wrong.
async function readLight(file) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  if (bytes[0] === 0x23 && bytes[1] === 0x3f) return readRadiance(file.name, bytes);
  if (bytes[0] === 0x76 && bytes[1] === 0x2f && bytes[2] === 0x31 && bytes[3] === 0x01)
    return readExr(file.name, bytes);
  throw new Error('it is neither Radiance (.hdr) nor OpenEXR (.exr)');
}

function readRadiance(name, bytes) {
  let at = 0;
  const line = () => {
    const end = bytes.indexOf(10, at);
    if (end < 0) throw new Error('its header has no end');
    const text = new TextDecoder().decode(bytes.subarray(at, end));
    at = end + 1;
    return text;
  };
  let exposure = 1;
  for (let text = line(); text; text = line()) {
    if (text.startsWith('FORMAT=') && text !== 'FORMAT=32-bit_rle_rgbe')
      throw new Error(`its format is ${text.slice(7)} and not 32-bit_rle_rgbe`);
    if (text.startsWith('EXPOSURE=')) exposure *= +text.slice(9) || 1;
  }
  const [, height, width] =
    line()
      .match(/^-Y (\d+) \+X (\d+)$/)
      ?.map(Number) ?? [];
  if (!width) throw new Error('its rows do not run from the top, left to right');
  if (width * height > 1 << 26) throw new Error('it has more than 67 million pixels');
  const data = new Float32Array(3 * width * height),
    row = new Uint8Array(4 * width);
  for (let y = 0; y < height; y++) {
    if (bytes[at] === 2 && bytes[at + 1] === 2 && bytes[at + 2] * 256 + bytes[at + 3] === width) {
      at += 4;
      for (let c = 0; c < 4; c++)
        for (let x = 0; x < width;) {
          const code = bytes[at++],
            count = code > 128 ? code - 128 : code;
          if (!count || x + count > width) throw new Error('a run in it is too long');
          for (let i = 0; i < count; i++) row[4 * x++ + c] = code > 128 ? bytes[at] : bytes[at + i];
          at += code > 128 ? 1 : count;
        }
    } else {
      row.set(bytes.subarray(at, at + 4 * width));
      at += 4 * width;
    }
    if (at > bytes.length) throw new Error('it is cut off');
    for (let x = 0; x < width; x++) {
      const scale = row[4 * x + 3] ? 2 ** (row[4 * x + 3] - 136) / exposure : 0;
      for (let c = 0; c < 3; c++) data[3 * (y * width + x) + c] = (row[4 * x + c] + 0.5) * scale;
    }
  }
  return new Environment(name, width, height, data);
}

async function readExr(name, bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let at = 8;
  const string = () => {
    const end = bytes.indexOf(0, at),
      text = new TextDecoder().decode(bytes.subarray(at, end));
    at = end + 1;
    return text;
  };
  if (view.getUint32(4, true) & 0x1a00)
    throw new Error('it has tiles, parts or deep pixels, and only scanlines are read');
  let channels = [],
    compression,
    box;
  for (let key = string(); key; key = string()) {
    const type = string(),
      size = view.getInt32(at, true),
      end = (at += 4) + size;
    if (type === 'chlist')
      for (let channel = string(); channel; at += 16, channel = string())
        channels.push({ name: channel, kind: view.getInt32(at, true) });
    if (type === 'compression') compression = bytes[at];
    if (key === 'dataWindow') box = [0, 4, 8, 12].map(i => view.getInt32(at + i, true));
    at = end;
  }
  const rows = { 0: 1, 2: 1, 3: 16 }[compression],
    [width, height] = [box[2] - box[0] + 1, box[3] - box[1] + 1];
  if (!rows) throw new Error('its compression is neither none nor ZIP');
  if (!(width > 0 && height > 0 && width * height <= 1 << 26)) throw new Error('its size is wrong');
  const places = ['R', 'G', 'B'].map(wanted => channels.findIndex(channel => channel.name === wanted));
  if (places.includes(-1)) throw new Error('it has no channels R, G and B');
  const sizes = channels.map(({ kind }) => (kind === 1 ? 2 : 4)),
    starts = sizes.map((_, i) => sizes.slice(0, i).reduce((a, b) => a + b, 0) * width);
  const stride = sizes.reduce((a, b) => a + b, 0) * width,
    data = new Float32Array(3 * width * height);
  let left = height;
  at += 8 * Math.ceil(height / rows);
  while (left > 0) {
    if (at + 8 > bytes.length) throw new Error('it is cut off');
    const first = view.getInt32(at, true) - box[1],
      size = view.getInt32(at + 4, true),
      count = Math.min(rows, height - first);
    let block = bytes.subarray(at + 8, at + 8 + size);
    at += 8 + size;
    left -= count;
    if (!(count > 0 && first >= 0)) throw new Error('a row in it lies outside');
    if (size < stride * count) block = await unzip(block, stride * count);
    const numbers = new DataView(block.buffer, block.byteOffset, block.byteLength);
    if (block.length < stride * count) throw new Error('it is cut off');
    for (let y = 0; y < count; y++)
      places.forEach((place, c) => {
        for (let x = 0, from = y * stride + starts[place], to = 3 * (first + y) * width + c; x < width; x++, to += 3)
          data[to] =
            channels[place].kind === 1
              ? half(numbers.getUint16(from + 2 * x, true))
              : channels[place].kind === 2
                ? numbers.getFloat32(from + 4 * x, true)
                : numbers.getUint32(from + 4 * x, true);
      });
  }
  return new Environment(name, width, height, data);
}

const half = bits => {
  const exponent = (bits >> 10) & 31,
    fraction = bits & 1023;
  return (
    (bits >> 15 ? -1 : 1) *
    (exponent === 31
      ? fraction
        ? NaN
        : Infinity
      : exponent
        ? 2 ** (exponent - 15) * (1 + fraction / 1024)
        : fraction * 2 ** -24)
  );
};

/// A block of rows: inflated, summed up, and its two halves interleaved.
async function unzip(block, length) {
  let packed;
  try {
    packed = new Uint8Array(
      await new Response(new Blob([block]).stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer(),
    );
  } catch {
    throw new Error('a block in it does not inflate');
  }
  if (packed.length !== length) throw new Error('a block in it has another size');
  for (let i = 1; i < length; i++) packed[i] += packed[i - 1] - 128;
  const out = new Uint8Array(length),
    middle = (length + 1) >> 1;
  for (let i = 0; i < length; i++) out[i] = packed[i & 1 ? middle + (i >> 1) : i >> 1];
  return out;
}
