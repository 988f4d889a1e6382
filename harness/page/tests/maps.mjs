// Maps of light as files, for tests.
import { deflateSync } from 'node:zlib';

/// An OpenEXR map of scanlines, red, green and blue in half precision, in blocks that ZIP compresses or none does. `bits` returns a number of a
/// block: by default some are 1.0, which is 0x3c00, and the others 0.5, which is 0x3800. In a row, all blue numbers come first and red ones last.
export function exr(isZip, bits = i => (i % 5 ? 0x3800 : 0x3c00), [width, height] = [32, 16]) {
  const attribute = (name, type, body) => Buffer.concat([Buffer.from(`${name}\0${type}\0`), int(body.length), body]);
  const int = (...numbers) => Buffer.from(Int32Array.from(numbers).buffer);
  const channels = Buffer.concat([
    ...['B', 'G', 'R'].map(name => Buffer.concat([Buffer.from(`${name}\0`), int(1, 0, 1, 1)])),
    Buffer.from([0]),
  ]);
  const head = Buffer.concat([
    Buffer.from([0x76, 0x2f, 0x31, 1, 2, 0, 0, 0]),
    attribute('channels', 'chlist', channels),
    attribute('compression', 'compression', Buffer.from([isZip ? 3 : 0])),
    attribute('dataWindow', 'box2i', int(0, 0, width - 1, height - 1)),
    attribute('displayWindow', 'box2i', int(0, 0, width - 1, height - 1)),
    attribute('lineOrder', 'lineOrder', Buffer.from([0])),
    Buffer.from([0]),
  ]);
  const rows = isZip ? 16 : 1,
    blocks = [];
  for (let y = 0; y < height; y += rows) {
    const raw = Buffer.from(Uint16Array.from({ length: 3 * width * rows }, (_, i) => bits(i, y)).buffer);
    let body = raw;
    if (isZip) {
      const halves = Buffer.from([...raw.filter((_, i) => !(i & 1)), ...raw.filter((_, i) => i & 1)]);
      body = deflateSync(halves.map((byte, i) => (i ? byte - halves[i - 1] + 128 : byte)));
    }
    blocks.push(Buffer.concat([int(y, body.length), body]));
  }
  // Where each block begins.
  let at = head.length + 8 * blocks.length;
  const places = blocks.map(block => {
    at += block.length;
    return BigInt(at - block.length);
  });
  return Buffer.concat([head, Buffer.from(BigInt64Array.from(places).buffer), ...blocks]);
}

/// A map of Radiance whose rows are not packed.
export const radiance = (width, height) =>
  Buffer.concat([
    Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`),
    Buffer.alloc(4 * width * height, 129),
  ]);
