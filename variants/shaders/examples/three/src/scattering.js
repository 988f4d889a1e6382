/// What a material does with light from all around: integrals over directions, by the module, for each inclination of the viewer.
import { direction } from '#page';

/// Inclinations of the table: evenly from -90 to 90 degrees, whose ends are moved in by half a degree.
export const INCLINATIONS = 33;
/// Numbers by inclination and channel: the total, the moments by u, v, u u, v v and u v, and the factor that conserves energy.
export const ROWS = 7;
const FACTOR = ROWS - 1;

/// Offsets h of half a fibre with their weights; the other half mirrors it. The albedo changes as fast as sqrt(1 - h^2) at the edge, so that
/// this is the rule of Gauss in the angle whose sine is h. A model of the far field needs none.
const OFFSETS = [
  [-0.8611363116, 0.3478548451],
  [-0.3399810436, 0.6521451549],
  [0.3399810436, 0.6521451549],
  [0.8611363116, 0.3478548451],
].map(([x, weight]) => [Math.sin((Math.PI / 4) * (1 + x)), weight * Math.cos((Math.PI / 4) * (1 + x))]);
const FAR = [[0, 1]];

/// Steps along and around the fibre: refined until the total is within 1% of the albedo that the kernel computes.
const GRIDS = [64, 128, 256];
const cells = GRIDS.map(rows => {
  const columns = 2 * rows,
    list = { count: rows * columns, u: [], v: [], w: [], weight: [] };
  for (let row = 0; row < rows; row++)
    for (let column = 0; column < columns; column++) {
      const theta = 180 * ((row + 0.5) / rows - 0.5),
        [u, v, w] = direction(theta, 360 * ((column + 0.5) / columns - 0.5)),
        cos = Math.hypot(v, w);
      list.u.push(u);
      list.v.push(v);
      list.w.push(w);
      // The cosine of S cos theta, and the one of the solid angle.
      list.weight.push((cos * cos * 2 * Math.PI ** 2) / list.count);
    }
  return list;
});

/// Integrals of S cos theta over incoming directions, for the material in slot 0 of the kernel.
///
/// - `table`: Float32Array of INCLINATIONS x ROWS x 4, the fourth number unused. Directions are in the frame of the hit: u along the fibre,
///   v towards the viewer. Moments with one w vanish, because the mean over h is even in w. The last row is 1, or the factor by which a
///   viewer gets back as much light as arrives, as `Conserving` of the library scales; the other rows have the factor.
/// - `forward`: mean forward albedo of hair in all directions, linear RGB: light that leaves within 90 degrees of its azimuth, as a mean
///   over inclinations by cos^2, the share of strands with an inclination that a ray meets.
///
/// Totals are those of the kernel's albedos, and the other numbers are in proportion: the quadrature decides shares alone.
export function scattering(kernel, material) {
  const model = kernel.model(material.model),
    { model: index } = kernel.entry(material),
    offsets = model.near_field ? OFFSETS : FAR,
    weights = offsets.reduce((sum, [, weight]) => sum + weight, 0);
  const table = new Float32Array(4 * ROWS * INCLINATIONS),
    forward = [0, 0, 0];
  let norm = 0;
  for (let step = 0; step < INCLINATIONS; step++) {
    const theta = Math.max(-89.5, Math.min(89.5, 180 * (step / (INCLINATIONS - 1) - 0.5))),
      by = Math.cos((theta * Math.PI) / 180) ** 2,
      views = offsets.map(([h, weight]) => ({
        share: weight / weights,
        ...oneView(kernel, index, model.lobes.length, { theta, h }),
      })),
      mean = pick => views.reduce((sum, view) => sum + view.share * pick(view), 0);
    norm += by;
    for (let c = 0; c < 3; c++) {
      const factor =
          1 /
          Math.max(
            1,
            mean(({ sums }) => sums[0][c]),
          ),
        at = 4 * ROWS * step + c;
      for (let row = 0; row < FACTOR; row++) table[at + 4 * row] = factor * mean(({ sums }) => sums[row][c]);
      table[at + 4 * FACTOR] = factor;
      forward[c] += factor * by * mean(({ ahead }) => ahead[c]);
    }
  }
  return { table, forward: forward.map(sum => Math.min(1, sum / norm)) };
}

/// The factors alone, four numbers by inclination.
export const factorsOf = table =>
  Float32Array.from({ length: 4 * INCLINATIONS }, (_, at) => table[4 * (ROWS * (at >> 2) + FACTOR) + (at & 3)]);

/// The place of an inclination between the rows of the table, in WGSL.
export const place = `
fn hairis_place(sine: f32) -> f32 {
  return (asin(clamp(sine, -1.0, 1.0)) / ${Math.PI} + 0.5) * ${INCLINATIONS - 1}.0;
}`;

function oneView(kernel, index, lobes, view) {
  kernel.setView(0, view, 2 ** lobes - 1);
  const { work } = kernel;
  work[0][0] = Math.sin((view.theta * Math.PI) / 180);
  kernel.calls.albedos(0, 1);
  const albedo = [0, 1, 2].map(c => [0, 1, 2, 3].reduce((sum, lobe) => sum + work[1 + 3 * lobe + c][0], 0));
  let sums, ahead, error;
  for (const grid of cells) {
    const { u, v, w, weight, count } = grid;
    [u, v, w].forEach((column, axis) => work[axis].set(column));
    kernel.calls.eval(0, index, 0, count);
    sums = Array.from({ length: FACTOR }, () => [0, 0, 0]);
    ahead = [0, 0, 0];
    error = 0;
    for (let c = 0; c < 3; c++) {
      const values = work[3 + c];
      let [total, mu, mv, muu, mvv, muv, front] = [0, 0, 0, 0, 0, 0, 0];
      for (let i = 0; i < count; i++) {
        const value = values[i] * weight[i],
          [a, b] = [u[i], v[i]];
        total += value;
        mu += value * a;
        mv += value * b;
        muu += value * a * a;
        mvv += value * b * b;
        muv += value * a * b;
        if (b < 0) front += value;
      }
      const by = total > 0 ? albedo[c] / total : 0;
      [total, mu, mv, muu, mvv, muv].forEach((sum, moment) => (sums[moment][c] = sum * by));
      ahead[c] = front * by;
      if (albedo[c] > 0) error = Math.max(error, Math.abs(total / albedo[c] - 1));
    }
    if (error < 0.01) break;
  }
  return { sums, ahead };
}
