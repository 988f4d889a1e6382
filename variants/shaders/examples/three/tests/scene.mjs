// The scene of the tests: strands in three.js, and the same strands for rays, line by line and without three.js.

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const sum = (a, b, t = 1) => a.map((x, i) => x + t * b[i]);
export const unit = a => a.map(x => x / Math.hypot(...a));
export const random = seed => () => {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 2 ** 32;
};

/// The frame of a hit on a strand: u along it, v towards the viewer.
export function frameOf(along, view) {
  const v = unit(sum(view, along, -dot(view, along)));
  return [along, v, cross(along, v)];
}
export const local = (frame, a) => frame.map(axis => dot(axis, a));

/// Five straight strands side by side, each leaning its own way: what three.js draws of them is what `hairis eval` says of each pixel.
export const SIDE = 256,
  EYE = [0.7, 0.5, 6],
  FOV = 40,
  RADIUS = 0.4,
  SUN = unit([0.5, 0.7, 0.6]),
  TURN = 0.4,
  SCALE = 0.9,
  SCENE = Array.from({ length: 5 }, (_, i) => [
    [i - 2 - 0.2 * Math.sin(2 * i), -1.3, Math.sin(i)],
    [i - 2 + 0.25 * Math.cos(i), 1.3, Math.sin(i) + 0.9 * Math.cos(2 * i)],
  ]);
const turned = ([x, y, z]) => [
  SCALE * (Math.cos(TURN) * x - Math.sin(TURN) * y) + 0.1,
  SCALE * (Math.sin(TURN) * x + Math.cos(TURN) * y) - 0.1,
  SCALE * z + 0.2,
];

/// What `draw` takes, but for the material.
export const GIVEN = { SCENE, RADIUS, SIDE, EYE, FOV, SUN, TURN, SCALE, lines: false, light: 2, harmonics: [] };

/// The ray of a pixel: rows from the top.
export function rayOf(column, row) {
  const forward = unit(EYE.map(x => -x)),
    right = unit(cross(forward, [0, 1, 0])),
    up = cross(right, forward),
    tan = Math.tan((FOV * Math.PI) / 360);
  const [x, y] = [(2 * (column + 0.5)) / SIDE - 1, 1 - (2 * (row + 0.5)) / SIDE];
  return unit(sum(sum(forward, right, tan * x), up, tan * y));
}

/// The strand that a ray meets well within its ribbon, with the place across it.
export function hitOf(ray) {
  let found = null;
  for (const ends of SCENE) {
    const [a, b] = ends.map(turned),
      length = Math.hypot(...sum(b, a, -1)),
      along = unit(sum(b, a, -1)),
      side = unit(cross(along, sum(EYE, a, -1))),
      normal = cross(along, side),
      t = dot(sum(a, EYE, -1), normal) / dot(ray, normal),
      offset = sum(sum(EYE, ray, t), a, -1),
      [across, place] = [dot(offset, side) / (SCALE * RADIUS), dot(offset, along) / length];
    if (Math.abs(across) > 1.3 || place < -0.02 || place > 1.02 || (found && found.t < t)) continue;
    found = { t, along, across, isWell: Math.abs(across) < 0.85 && place > 0.05 && place < 0.95 };
  }
  return found?.isWell ? found : null;
}

/// How far the offset of a hit may be from that of its pixel, because a driver in software moves the corners of ribbons to the next
/// sixteenth of a pixel.
export const snappedBy = ({ t }) => (t * Math.tan((FOV * Math.PI) / 360)) / (8 * SCALE * RADIUS * SIDE);

/// Draws the scene with a material in a page, and returns its pixels in linear light, rows from the top.
export async function draw(page, given) {
  const { floats, forward } = await page.evaluate(drawn, given),
    bytes = Uint8Array.from(Buffer.from(floats, 'base64'));
  return { pixels: new Float32Array(bytes.buffer), forward };
}

/// In the browser: pixels as floats in base64, because a list of numbers takes a second.
async function drawn({
  SCENE,
  RADIUS,
  SIDE,
  EYE,
  FOV,
  SUN,
  TURN,
  SCALE,
  model,
  values,
  lines,
  light,
  harmonics,
}) {
  const { THREE, library, renderer, Strands } = globalThis.hairis;
  renderer.setAnimationLoop(null);
  const strands = new Strands(
    Float32Array.from(SCENE.flatMap(ends => ends.flatMap(p => [...p, RADIUS]))),
    Uint32Array.from(SCENE, (_, i) => 2 * i + 2),
  );
  const sun = new THREE.DirectionalLight(0xffffff, light);
  sun.color.setRGB(1, 0.8, 0.6);
  sun.position.fromArray(SUN);
  const environment = new THREE.SphericalHarmonics3();
  harmonics.forEach((color, i) => environment.coefficients[i].fromArray(color));
  const material = await library.material(model, values, { light: sun, environment, lines });
  const mesh = lines
    ? new THREE.LineSegments(globalThis.hairis.lines(strands), material)
    : new THREE.Mesh(globalThis.hairis.ribbons(strands), material);
  mesh.rotation.z = TURN;
  mesh.scale.setScalar(SCALE);
  mesh.position.set(0.1, -0.1, 0.2);
  const scene = new THREE.Scene();
  scene.add(mesh, sun, sun.target);
  const camera = new THREE.PerspectiveCamera(FOV, 1, 0.1, 50);
  camera.position.fromArray(EYE);
  camera.lookAt(0, 0, 0);
  const target = new THREE.RenderTarget(SIDE, SIDE, { type: THREE.FloatType });
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  renderer.setRenderTarget(null);
  const { buffer, byteOffset, byteLength } = await renderer.readRenderTargetPixelsAsync(target, 0, 0, SIDE, SIDE);
  let floats = '';
  // As many arguments as a call takes.
  for (let at = 0; at < byteLength; at += 4096)
    floats += String.fromCharCode(...new Uint8Array(buffer, byteOffset + at, Math.min(4096, byteLength - at)));
  const { forward } = material;
  target.dispose();
  // The material stays, so that others of its model have its shader.
  return { floats: btoa(floats), forward: forward.value.toArray() };
}

/// Radiance of spherical harmonics in a direction, by their definition.
export function radiance(harmonics, [x, y, z]) {
  const basis = [
    0.282095,
    0.488603 * y,
    0.488603 * z,
    0.488603 * x,
    1.092548 * x * y,
    1.092548 * y * z,
    0.315392 * (3 * z * z - 1),
    1.092548 * x * z,
    0.546274 * (x * x - y * y),
  ];
  return [0, 1, 2].map(c => basis.reduce((total, value, i) => total + value * harmonics[i][c], 0));
}
