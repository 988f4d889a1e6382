/// How many strands lie between a place and the light: a volume over the box of the hair, as a texture for the material.
import { Data3DTexture, DataUtils, HalfFloatType, LinearFilter, RGFormat, Vector3 } from 'three/webgpu';
import { sphereOf } from './geometry.js';

/// Directions over which the light from all around is averaged: the axes and the diagonals of a cube.
const AROUND = [-1, 0, 1]
  .flatMap(x => [-1, 0, 1].flatMap(y => [-1, 0, 1].map(z => new Vector3(x, y, z))))
  .filter(v => v.lengthSq() & 1);

/// Expected crossings by place. A ray that crosses a cell of cross-section A meets 2 r l sin(angle) / A strands in the mean, if a segment
/// of radius r and length l lies in the cell; these numbers are summed along the ray, a place counts half of its own cell, and places
/// between cells are interpolated. What is finer than a cell is therefore smoothed: single strands cast no shadow.
export class Crossings {
  /// `size`: cells along each side of the volume.
  constructor(strands, size = 48) {
    this.strands = strands;
    this.size = size;
    const { center, radius } = sphereOf(strands);
    this.low = center.clone().addScalar(-radius);
    this.side = 2 * radius;
    this.data = new Uint16Array(2 * size ** 3);
    this.texture = new Data3DTexture(this.data, size, size, size);
    Object.assign(this.texture, {
      format: RGFormat,
      type: HalfFloatType,
      minFilter: LinearFilter,
      magFilter: LinearFilter,
    });
    this.light = new Vector3();
    this.fillAround();
  }

  /// Crossings that a strand of radius 1 across the light adds to places on itself, which do not count: it crosses its cell as 2 r l / A, a
  /// place counts half of that, and keeps three quarters where it is interpolated between cells, in the mean over places in a cell.
  get own() {
    return (0.75 * this.size) / this.side;
  }

  /// Red of the texture: crossings towards `light`, a unit vector in the space of the strands. Does nothing for the same light.
  update(light) {
    if (this.light.distanceToSquared(light) < 1e-12) return;
    this.light.copy(light);
    this.along(light).forEach((count, cell) => (this.data[2 * cell] = DataUtils.toHalfFloat(count)));
    this.texture.needsUpdate = true;
  }

  /// Green of the texture: the number n that dims light from all around as its mean over directions is dimmed, exp(-n) = mean exp(-count).
  fillAround() {
    const sum = new Float32Array(this.size ** 3);
    for (const direction of AROUND)
      this.along(direction.clone().normalize()).forEach((count, cell) => (sum[cell] += Math.exp(-count)));
    sum.forEach(
      (total, cell) =>
        (this.data[2 * cell + 1] = DataUtils.toHalfFloat(-Math.log(Math.max(total, 1e-30) / AROUND.length))),
    );
    this.texture.needsUpdate = true;
  }

  /// Crossings from the middle of each cell towards a unit vector, by way of a grid whose third axis is that vector.
  along(direction) {
    const { strands, size, low, side } = this,
      { nodes } = strands,
      cell = side / size;
    const u = new Vector3(...(Math.abs(direction.y) < 0.9 ? [0, 1, 0] : [1, 0, 0])).cross(direction).normalize(),
      v = direction.clone().cross(u),
      middle = low.clone().addScalar(side / 2);
    const axes = [u, v, direction].map(axis => [axis.x, axis.y, axis.z, size / 2 - axis.dot(middle) / cell]);
    const [iu, iv, id] = axes.map(
      ([x, y, z, at]) =>
        (p, i) =>
          (x * p[i] + y * p[i + 1] + z * p[i + 2]) / cell + at,
    );
    const bound = x => Math.max(0, Math.min(size - 1, Math.floor(x))),
      grid = new Float32Array(size ** 3);
    const point = [0, 0, 0];
    strands.segments(node => {
      const a = 4 * node,
        step = [0, 1, 2].map(axis => nodes[a + 4 + axis] - nodes[a + axis]),
        length = Math.hypot(...step),
        across = Math.sqrt(Math.max(0, length ** 2 - direction.dot({ x: step[0], y: step[1], z: step[2] }) ** 2)),
        parts = Math.ceil(length / cell) || 1,
        share = ((nodes[a + 3] + nodes[a + 7]) * across) / (cell * cell * parts);
      for (let part = 0; part < parts; part++) {
        for (let axis = 0; axis < 3; axis++) point[axis] = nodes[a + axis] + (step[axis] * (part + 0.5)) / parts;
        grid[bound(iu(point, 0)) + size * (bound(iv(point, 0)) + size * bound(id(point, 0)))] += share;
      }
    });
    // From the light down: what lies before a cell, and half of what lies in it.
    const layer = size * size;
    for (let column = 0; column < layer; column++)
      for (let at = column + layer * (size - 1), before = 0; at >= 0; at -= layer) {
        const here = grid[at];
        grid[at] = before + here / 2;
        before += here;
      }
    const out = new Float32Array(size ** 3);
    for (let z = 0, at = 0; z < size; z++)
      for (let y = 0; y < size; y++)
        for (let x = 0; x < size; x++, at++) {
          [point[0], point[1], point[2]] = [
            low.x + (x + 0.5) * cell,
            low.y + (y + 0.5) * cell,
            low.z + (z + 0.5) * cell,
          ];
          out[at] = between(grid, size, iu(point, 0) - 0.5, iv(point, 0) - 0.5, id(point, 0) - 0.5);
        }
    return out;
  }
}

/// A grid at a place between its cells.
function between(grid, size, x, y, z) {
  const split = at => {
    const inside = Math.max(0, Math.min(size - 1, at)),
      floor = Math.min(size - 2, Math.floor(inside));
    return [floor, inside - floor];
  };
  const [i, fx] = split(x),
    [j, fy] = split(y),
    [k, fz] = split(z);
  let sum = 0;
  for (let corner = 0; corner < 8; corner++) {
    const [a, b, c] = [corner & 1, (corner >> 1) & 1, corner >> 2];
    sum += (a ? fx : 1 - fx) * (b ? fy : 1 - fy) * (c ? fz : 1 - fz) * grid[i + a + size * (j + b + size * (k + c))];
  }
  return sum;
}
