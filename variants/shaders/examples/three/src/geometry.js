/// Geometry of strands for three.js.
import {
  Box3,
  BufferGeometry,
  Float32BufferAttribute,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Sphere,
  Vector3,
} from 'three/webgpu';

/// The sphere around the box of all strands.
export function sphereOf(strands) {
  const { low, high } = strands.box;
  return new Box3(new Vector3(...low), new Vector3(...high)).getBoundingSphere(new Sphere());
}

/// Ribbons that face the camera: one instance of a quad for each segment, which the vertex stage of `HairMaterial` widens.
export function ribbons(strands) {
  const geometry = new InstancedBufferGeometry(),
    { nodes, tangents, count } = strands;
  // x is the end of the segment, y the side.
  geometry.setAttribute('position', new Float32BufferAttribute([0, -1, 0, 0, 1, 0, 1, -1, 0, 1, 1, 0], 3));
  geometry.setIndex([0, 1, 2, 2, 1, 3]);
  const [starts, stops, first, last] = [4, 4, 3, 3].map(width => new Float32Array(width * count));
  let at = 0;
  strands.segments(node => {
    starts.set(nodes.subarray(4 * node, 4 * node + 4), 4 * at);
    stops.set(nodes.subarray(4 * node + 4, 4 * node + 8), 4 * at);
    first.set(tangents.subarray(3 * node, 3 * node + 3), 3 * at);
    last.set(tangents.subarray(3 * node + 3, 3 * node + 6), 3 * at);
    at++;
  });
  for (const [name, array, width] of [
    ['start', starts, 4],
    ['stop', stops, 4],
    ['startTangent', first, 3],
    ['stopTangent', last, 3],
  ])
    geometry.setAttribute(name, new InstancedBufferAttribute(array, width));
  geometry.instanceCount = count;
  geometry.boundingSphere = sphereOf(strands);
  return geometry;
}

/// Lines of one pixel for `LineSegments`: cheaper than ribbons, as wide at every distance, and shaded by the mean over the fibre.
export function lines(strands) {
  const geometry = new BufferGeometry(),
    { nodes, tangents, count } = strands;
  const [places, directions, radii] = [6, 6, 2].map(width => new Float32Array(width * count));
  let at = 0;
  strands.segments(node => {
    for (const end of [node, node + 1]) {
      places.set(nodes.subarray(4 * end, 4 * end + 3), at);
      directions.set(tangents.subarray(3 * end, 3 * end + 3), at);
      radii[at / 3] = nodes[4 * end + 3];
      at += 3;
    }
  });
  geometry.setAttribute('position', new Float32BufferAttribute(places, 3));
  geometry.setAttribute('tangent', new Float32BufferAttribute(directions, 3));
  geometry.setAttribute('radius', new Float32BufferAttribute(radii, 1));
  geometry.boundingSphere = sphereOf(strands);
  return geometry;
}
