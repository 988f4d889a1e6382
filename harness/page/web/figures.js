// Figures: integrals over the sphere of what the module evaluates.

/// Directions of a grid in inclination and azimuth, written into columns, with the solid angle of a cell in each row.
class SphereGrid {
  constructor(width, height) {
    Object.assign(this, { width, height, count: width * height });
    this.cos = new Float64Array(height);
    this.area = new Float64Array(height);
    for (let row = 0; row < height; row++) {
      const [upper, centre, lower] = [row, row + 0.5, row + 1].map(at => Math.PI * (0.5 - at / height));
      this.cos[row] = Math.cos(centre);
      this.area[row] = ((Math.sin(upper) - Math.sin(lower)) * 2 * Math.PI) / width;
    }
  }

  write([x, y, z]) {
    for (let row = 0, at = 0; row < this.height; row++) {
      const theta = Math.PI * (0.5 - (row + 0.5) / this.height);
      const sin = Math.sin(theta),
        cos = Math.cos(theta);
      for (let column = 0; column < this.width; column++, at++) {
        const phi = 2 * Math.PI * ((column + 0.5) / this.width - 0.5);
        x[at] = sin;
        y[at] = cos * Math.cos(phi);
        z[at] = cos * Math.sin(phi);
      }
    }
  }

  /// Cell of a direction.
  cell(x, y, z) {
    const theta = Math.asin(Math.max(-1, Math.min(1, x))),
      phi = Math.atan2(z, y);
    const row = Math.min(this.height - 1, Math.floor((0.5 - theta / Math.PI) * this.height));
    return [(phi / (2 * Math.PI) + 0.5) * this.width, (0.5 - theta / Math.PI) * this.height, row];
  }
}

const MAP = new SphereGrid(WIDTH, HEIGHT);
// Densities of samplers have steps in the inclination, so that rows count for more than columns there.
const FINE = new SphereGrid(256, 512),
  COARSE = new SphereGrid(128, 256);

/// Directions of unit solid angles over the support of a light, as columns and weights.
function patch(cells, place) {
  const columns = [0, 1, 2].map(() => new Float32Array(cells * cells)),
    weight = new Float64Array(cells * cells);
  for (let i = 0, at = 0; i < cells; i++)
    for (let j = 0; j < cells; j++, at++) {
      const { dir, solid } = place((i + 0.5) / cells, (j + 0.5) / cells);
      turned(dir).forEach((x, axis) => {
        columns[axis][at] = x;
      });
      weight[at] = solid / (cells * cells);
    }
  return { columns, weight, count: cells * cells };
}

/// Azimuth of the viewer from straight up, in degrees, where the lights stand as `hairis compare` has them.
const VIEWER = 60;
const turned = ([u, v, w]) => {
  const [cos, sin] = [Math.cos(VIEWER * RAD), Math.sin(VIEWER * RAD)];
  return [u, v * cos + w * sin, w * cos - v * sin];
};

const SUN = direction(-60, 25),
  SUN_HEIGHT = 2 * Math.sin(0.25 * 5 * RAD) ** 2,
  HALF_SIDES = [2, 0.5];

/// A point of the rectangle above the fibre, in angles, so that the integrand is flat along it.
function rectangle(s, t) {
  const [p, q] = [s, t].map((x, axis) => (2 * x - 1) * Math.atan(HALF_SIDES[axis]));
  const [x, z] = [Math.tan(p), Math.tan(q)],
    square = x * x + z * z + 1,
    length = Math.sqrt(square);
  const range = 4 * Math.atan(HALF_SIDES[0]) * Math.atan(HALF_SIDES[1]);
  return { dir: [x / length, 1 / length, z / length], solid: (range * (x * x + 1) * (z * z + 1)) / (square * length) };
}

/// A point of the sun.
function sun(s, t) {
  const fall = SUN_HEIGHT * s,
    phi = 2 * Math.PI * t,
    sine = Math.sqrt(fall * (2 - fall));
  const [x, y, z] = SUN,
    side = normalized([-y, x, 0]),
    up = [y * side[2] - z * side[1], z * side[0] - x * side[2], x * side[1] - y * side[0]];
  const dir = [0, 1, 2].map(i => (1 - fall) * SUN[i] + sine * (Math.cos(phi) * side[i] + Math.sin(phi) * up[i]));
  return { dir, solid: 2 * Math.PI * SUN_HEIGHT };
}

function normalized(v) {
  const length = Math.hypot(...v);
  return v.map(x => x / length);
}

const SMOOTH = { axis: turned([0.36, 0.8, 0.48]), mean: [1, 0.9, 0.8], contrast: [0.5, 0.6, 0.8] };
const LIGHTS = [
  { name: 'constant' },
  { name: 'smooth', smooth: true },
  { name: 'area light', patches: [64, 32].map(cells => patch(cells, rectangle)) },
  { name: '5° sun', patches: [24, 12].map(cells => patch(cells, sun)) },
];

/// Mean over the channels of S cos theta of every cell of a map, its integral, its peak, and the integral over every second cell.
function measureMap(columns, into) {
  const [, , , r, g, b] = columns;
  let total = 0,
    peak = 0,
    coarse = 0;
  for (let row = 0, at = 0; row < HEIGHT; row++) {
    const by = MAP.cos[row] / 3;
    let sum = 0,
      every = 0;
    for (let column = 0; column < WIDTH; column++, at++) {
      const value = (r[at] + g[at] + b[at]) * by;
      into[at] = value;
      sum += value;
      if (value > peak) peak = value;
      if (column & 1) every += value;
    }
    total += sum * MAP.area[row];
    if (row & 1) coarse += 4 * every * MAP.area[row];
  }
  return { total, peak, error: Math.abs(total - coarse) };
}

/// L1 difference of two maps, relative to the first.
function measureDifference(first, second, into) {
  let total = 0,
    of = 0,
    coarse = 0,
    coarseOf = 0,
    peak = 0;
  for (let row = 0, at = 0; row < HEIGHT; row++) {
    let sum = 0,
      norm = 0,
      every = 0,
      everyNorm = 0;
    for (let column = 0; column < WIDTH; column++, at++) {
      const difference = second[at] - first[at],
        size = Math.abs(difference);
      into[at] = difference;
      sum += size;
      norm += first[at];
      if (size > peak) peak = size;
      if (column & 1) {
        every += size;
        everyNorm += first[at];
      }
    }
    total += sum * MAP.area[row];
    of += norm * MAP.area[row];
    if (row & 1) {
      coarse += every * MAP.area[row];
      coarseOf += everyNorm * MAP.area[row];
    }
  }
  const l1 = of > 0 ? total / of : NaN;
  return { l1, error: Math.abs(l1 - coarse / coarseOf), peak };
}

/// Sums of L S cos theta, of its square over a density, and of the density, for each density.
class Sums {
  constructor(samplers) {
    this.mean = 0;
    this.squares = new Float64Array(samplers);
    this.masses = new Float64Array(samplers);
  }
  add(value, weight, density, sampler) {
    if (sampler === 0) this.mean += value * weight;
    if (value > 0) this.squares[sampler] += ((value * value) / density) * weight;
    this.masses[sampler] += density * weight;
  }
  /// V; over the whole sphere as the variance about the mean, so that errors of the grid in both moments cancel.
  v(isSphere) {
    return Array.from(
      this.squares,
      (square, sampler) => square / this.mean ** 2 - 1 + (isSphere ? this.masses[sampler] - 1 : 0),
    );
  }
}

/// V of one sample under each light, uniform directions first, then every sampler of the model: [light][sampler] of value and error.
/// A quick look has a coarser grid.
function measureVariance(slot, entries, isQuick) {
  const grids = isQuick ? [COARSE, new SphereGrid(64, 128)] : [FINE, COARSE];
  const [fine, coarse] = grids.map((grid, level) => [
    ...sphereVariance(slot, entries, grid),
    ...LIGHTS.flatMap(light => (light.patches ? [patchVariance(slot, entries, light.patches[level])] : [])),
  ]);
  return fine.map((row, light) => withErrors(row, coarse[light]));
}

const withErrors = (fine, coarse) => fine.map((value, i) => ({ value, error: Math.abs(value - coarse[i]) }));

/// V under the constant and the smooth light.
function sphereVariance(slot, entries, grid) {
  const columns = kernel.work,
    [x, y, z, r, g, b, pdf] = columns,
    { axis, mean, contrast } = SMOOTH;
  const sums = [0, 1].map(() => new Sums(entries.length + 1));
  grid.write(columns);
  entries.forEach((entry, sampler) => {
    kernel.calls.eval(slot, entry.model, false, grid.count);
    for (let row = 0, at = 0; row < grid.height; row++) {
      const by = grid.cos[row] / 3,
        area = grid.area[row];
      for (let column = 0; column < grid.width; column++, at++) {
        const [constant, smooth] = sums,
          t = axis[0] * x[at] + axis[1] * y[at] + axis[2] * z[at];
        const even = (r[at] + g[at] + b[at]) * by;
        const lit =
          by *
          (r[at] * mean[0] * (1 + contrast[0] * t) +
            g[at] * mean[1] * (1 + contrast[1] * t) +
            b[at] * mean[2] * (1 + contrast[2] * t));
        if (sampler === 0) {
          constant.add(even, area, 0.25 / Math.PI, 0);
          smooth.add(lit, area, 0.25 / Math.PI, 0);
        }
        constant.add(even, area, pdf[at], sampler + 1);
        smooth.add(lit, area, pdf[at], sampler + 1);
      }
    }
  });
  return sums.map(sum => sum.v(true));
}

/// V under a light of constant radiance over a patch.
function patchVariance(slot, entries, { columns, weight, count }) {
  const [x, y, z, r, g, b, pdf] = kernel.work,
    sums = new Sums(entries.length + 1);
  [x, y, z].forEach((column, axis) => column.set(columns[axis]));
  entries.forEach((entry, sampler) => {
    kernel.calls.eval(slot, entry.model, false, count);
    for (let at = 0; at < count; at++) {
      const value = ((r[at] + g[at] + b[at]) / 3) * Math.sqrt(Math.max(0, 1 - x[at] * x[at]));
      if (sampler === 0) sums.add(value, weight[at], 0.25 / Math.PI, 0);
      sums.add(value, weight[at], pdf[at], sampler + 1);
    }
  });
  return sums.v(false);
}

/// S cos theta, mean over the channels, along a line of directions; for each set of lobes.
function profile(slot, entry, view, masks, directions) {
  const [x, y, z, r, g, b] = kernel.work;
  directions.forEach(([u, v, w], at) => {
    x[at] = u;
    y[at] = v;
    z[at] = w;
  });
  return masks.map(mask => {
    kernel.setView(slot, view, mask);
    kernel.calls.eval(slot, entry.model, false, directions.length);
    return Float64Array.from(
      directions,
      ([u], at) => ((r[at] + g[at] + b[at]) / 3) * Math.sqrt(Math.max(0, 1 - u * u)),
    );
  });
}

/// Directional albedo, mean over the channels, at inclinations in degrees: as it is, and as `Conserving` leaves it, with each channel
/// divided by the albedo of all lobes where that is above 1; it leaves models alone that conserve energy by their parameters.
function albedoCurves(slot, model, lobes, inclinations) {
  inclinations.forEach((theta, at) => {
    kernel.work[0][at] = Math.sin(theta * RAD);
  });
  kernel.calls.albedos(slot, inclinations.length);
  const plain = inclinations.map(() => 0),
    conserving = inclinations.map(() => 0);
  for (let at = 0; at < inclinations.length; at++)
    for (let c = 0; c < 3; c++) {
      let [all, shown] = [0, 0];
      for (let lobe = 0; lobe < 4; lobe++) {
        const albedo = kernel.work[1 + 3 * lobe + c][at];
        all += albedo;
        if ((lobes >> lobe) & 1) shown += albedo;
      }
      plain[at] += shown / 3;
      conserving[at] += shown / (model.conserves ? 1 : Math.max(1, all)) / 3;
    }
  return [conserving, plain];
}
