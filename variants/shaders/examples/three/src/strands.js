/// Strands of hair.

/// Polylines with a radius: `nodes` holds x, y, z and the radius of each node, and `ends[i]` is the number of nodes up to the end of
/// strand i, each of which has at least two nodes. Normals, tangents and lengths follow from the nodes.
export class Strands {
  /// `nodes`: Float32Array of 4 numbers a node; `ends`: growing numbers of nodes.
  constructor(nodes, ends) {
    this.nodes = nodes;
    this.ends = ends;
    this.tangents = tangentsOf(this);
  }

  /// Reads cyHair (`.hair`), the format that `hairis-render --export` writes.
  static read(buffer) {
    return readHair(buffer);
  }

  /// Every strand whose number is a multiple of `step`, `wider` times as thick.
  every(step, wider = 1) {
    const nodes = [],
      ends = [];
    let first = 0;
    this.ends.forEach((end, strand) => {
      if (strand % step === 0) {
        for (let at = 4 * first; at < 4 * end; at++) nodes.push(this.nodes[at]);
        ends.push(nodes.length / 4);
      }
      first = end;
    });
    const thinned = Float32Array.from(nodes, (x, at) => (at % 4 < 3 ? x : x * wider));
    return new Strands(thinned, Uint32Array.from(ends));
  }

  /// Calls `visit(first)` with the first node of every segment.
  segments(visit) {
    let node = 0;
    for (const end of this.ends) {
      for (; node + 1 < end; node++) visit(node);
      node = end;
    }
  }

  /// Number of segments.
  get count() {
    return this.nodes.length / 4 - this.ends.length;
  }

  /// The least and the largest coordinates of all strands with their radii.
  get box() {
    const low = [Infinity, Infinity, Infinity],
      high = [-Infinity, -Infinity, -Infinity],
      { nodes } = this;
    for (let at = 0; at < nodes.length; at += 4)
      for (let axis = 0; axis < 3; axis++) {
        low[axis] = Math.min(low[axis], nodes[at + axis] - nodes[at + 3]);
        high[axis] = Math.max(high[axis], nodes[at + axis] + nodes[at + 3]);
      }
    return { low, high };
  }
}

/// Unit tangents of the nodes, from root to tip: the mean direction of the segments that meet there.
function tangentsOf({ nodes, ends }) {
  const tangents = new Float32Array((3 * nodes.length) / 4);
  let first = 0;
  for (const end of ends) {
    for (let node = first; node < end; node++) {
      const sum = [0, 0, 0];
      for (const a of [node - 1, node]) {
        if (a < first || a + 1 >= end) continue;
        const step = [0, 1, 2].map(axis => nodes[4 * (a + 1) + axis] - nodes[4 * a + axis]),
          length = Math.hypot(...step) || 1;
        for (let axis = 0; axis < 3; axis++) sum[axis] += step[axis] / length;
      }
      const length = Math.hypot(...sum) || 1;
      tangents.set(
        sum.map(x => x / length),
        3 * node,
      );
    }
    first = end;
  }
  return tangents;
}

/// Reads cyHair: a header of 128 bytes, then segments per strand, points and thicknesses where its flags say so.
function readHair(buffer) {
  const view = new DataView(buffer),
    fail = problem => new Error(`A file of hair must be cyHair: ${problem}.`);
  if (buffer.byteLength < 128 || view.getUint32(0, true) !== 0x52494148) throw fail('it does not begin with HAIR');
  const [count, points, flags, segments] = [4, 8, 12, 16].map(at => view.getUint32(at, true)),
    thickness = view.getFloat32(20, true);
  if (!(flags & 2)) throw fail('it has no points');
  let at = 128;
  const take = bytes => {
    if (at + bytes > buffer.byteLength) throw fail(`it has ${buffer.byteLength} bytes and needs ${at + bytes}`);
    at += bytes;
    return at - bytes;
  };
  const lengths = flags & 1 ? take(2 * count) : -1,
    places = take(12 * points),
    widths = flags & 4 ? take(4 * points) : -1;
  const nodes = new Float32Array(4 * points),
    ends = [];
  let end = 0;
  for (let strand = 0; strand < count; strand++) {
    end += 1 + (lengths < 0 ? segments : view.getUint16(lengths + 2 * strand, true));
    if (end - (ends.at(-1) ?? 0) < 2) throw fail(`strand ${strand} has no segment`);
    ends.push(end);
  }
  if (end !== points) throw fail(`its strands have ${end} points, its header says ${points}`);
  for (let point = 0; point < points; point++) {
    for (let axis = 0; axis < 3; axis++)
      nodes[4 * point + axis] = view.getFloat32(places + 12 * point + 4 * axis, true);
    nodes[4 * point + 3] = (widths < 0 ? thickness : view.getFloat32(widths + 4 * point, true)) / 2;
  }
  if (!nodes.every(Number.isFinite)) throw fail('a number in it is not finite');
  return new Strands(nodes, Uint32Array.from(ends));
}
