/// Tree of boxes over the segments of strands, for rays on the GPU.

const LEAF = 4,
  BINS = 16,
  /// Depth from which a node is halved, so that no ray needs a longer stack than `paths.wgsl` has.
  DEEP = 16;

/// Builds the tree by the surface areas of the boxes.
///
/// - `boxes`: eight numbers a node as floats: the low corner and an index, the high corner and a count, both as bits of integers. A leaf
///   has a count above 0 and the index of its first segment; another node has its children at the index and the next.
/// - `segments`: for each segment in the order of the leaves its first node and its strand.
export function buildTree(strands) {
  const { nodes, count } = strands,
    first = new Uint32Array(count),
    strandOf = new Uint32Array(count),
    bounds = new Float32Array(6 * count);
  let [at, strand] = [0, 0];
  strands.segments(node => {
    while (node >= strands.ends[strand]) strand++;
    [first[at], strandOf[at]] = [node, strand];
    for (let axis = 0; axis < 3; axis++) {
      const [a, b] = [4 * node, 4 * node + 4];
      bounds[6 * at + axis] = Math.min(nodes[a + axis] - nodes[a + 3], nodes[b + axis] - nodes[b + 3]);
      bounds[6 * at + 3 + axis] = Math.max(nodes[a + axis] + nodes[a + 3], nodes[b + axis] + nodes[b + 3]);
    }
    at++;
  });
  const order = Uint32Array.from({ length: count }, (_, i) => i),
    floats = new Float32Array(8 * 2 * count),
    ints = new Uint32Array(floats.buffer);
  const middle = (segment, axis) => bounds[6 * segment + axis] + bounds[6 * segment + 3 + axis];
  let used = 1;
  const tasks = [[0, 0, count, 0]];
  while (tasks.length) {
    const [place, begin, end, depth] = tasks.pop(),
      box = boxOf(bounds, order, begin, end);
    floats.set(box.subarray(0, 3), 8 * place);
    floats.set(box.subarray(3), 8 * place + 4);
    if (end - begin <= LEAF) {
      [ints[8 * place + 3], ints[8 * place + 7]] = [begin, end - begin];
      continue;
    }
    const split = depth < DEEP ? bestSplit(bounds, order, begin, end, middle) : null;
    let cut = begin;
    if (split) {
      for (let i = begin; i < end; i++)
        if (split.bin(middle(order[i], split.axis)) <= split.last) {
          [order[i], order[cut]] = [order[cut], order[i]];
          cut++;
        }
    }
    if (cut === begin || cut === end) {
      const axis = [0, 1, 2].reduce((most, next) =>
        box[3 + next] - box[next] > box[3 + most] - box[most] ? next : most,
      );
      order.subarray(begin, end).sort((a, b) => middle(a, axis) - middle(b, axis));
      cut = (begin + end) >> 1;
    }
    [ints[8 * place + 3], ints[8 * place + 7]] = [used, 0];
    tasks.push([used, begin, cut, depth + 1], [used + 1, cut, end, depth + 1]);
    used += 2;
  }
  const segments = new Uint32Array(2 * count);
  order.forEach((segment, i) => segments.set([first[segment], strandOf[segment]], 2 * i));
  return { boxes: floats.subarray(0, 8 * used), segments };
}

function boxOf(bounds, order, begin, end) {
  const box = new Float32Array([Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity]);
  for (let i = begin; i < end; i++) grow(box, bounds, 6 * order[i]);
  return box;
}

function grow(box, bounds, from) {
  for (let axis = 0; axis < 3; axis++) {
    if (bounds[from + axis] < box[axis]) box[axis] = bounds[from + axis];
    if (bounds[from + 3 + axis] > box[3 + axis]) box[3 + axis] = bounds[from + 3 + axis];
  }
}

/// The cheapest of the cuts between bins along three axes, or null if all middles coincide.
function bestSplit(bounds, order, begin, end, middle) {
  let best = null;
  for (let axis = 0; axis < 3; axis++) {
    let [low, high] = [Infinity, -Infinity];
    for (let i = begin; i < end; i++) {
      const x = middle(order[i], axis);
      if (x < low) low = x;
      if (x > high) high = x;
    }
    if (!(high > low)) continue;
    const bin = x => Math.min(BINS - 1, Math.floor((BINS * (x - low)) / (high - low))),
      counts = new Array(BINS).fill(0),
      boxes = counts.map(() => boxOf(bounds, order, 0, 0));
    for (let i = begin; i < end; i++) {
      const into = bin(middle(order[i], axis));
      counts[into]++;
      grow(boxes[into], bounds, 6 * order[i]);
    }
    const costs = [],
      sweep = places => {
        const box = boxOf(bounds, order, 0, 0);
        let count = 0;
        for (const place of places) {
          if (counts[place]) grow(box, boxes[place], 0);
          count += counts[place];
          const [x, y, z] = [0, 1, 2].map(axis => box[3 + axis] - box[axis]);
          costs[place] = (costs[place] ?? 0) + (count ? count * (x * y + y * z + z * x) : 0);
        }
      };
    const forth = counts.map((_, i) => i);
    sweep(forth);
    const left = [...costs];
    costs.fill(0);
    sweep(forth.reverse());
    for (let last = 0; last < BINS - 1; last++) {
      const cost = left[last] + costs[last + 1];
      if (!best || cost < best.cost) best = { cost, axis, last, bin };
    }
  }
  return best;
}
