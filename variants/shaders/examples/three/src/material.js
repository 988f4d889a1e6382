/// Node material of hair for WebGPURenderer: generated WGSL of a model, one directional light, and light from all around.
import { Matrix4, NodeMaterial, SphericalHarmonics3, Vector2, Vector3, Vector4 } from 'three/webgpu';
import {
  attribute,
  cameraPosition,
  cameraProjectionMatrix,
  cross,
  dot,
  float,
  mix,
  modelViewMatrix,
  modelWorldMatrix,
  modelWorldMatrixInverse,
  normalize,
  positionGeometry,
  positionWorld,
  screenCoordinate,
  screenSize,
  texture3D,
  uniform,
  uniformArray,
  varying,
  vec3,
  vec4,
  wgsl,
  wgslFn,
} from 'three/tsl';
import { GAIN, dim, multiple } from './multiple.js';
import { INCLINATIONS, ROWS, place, scattering } from './scattering.js';
import { hitFunction } from './models.js';

/// Hair of one model. `Hairis.material` makes it, after it has loaded the source of the model.
///
/// - `light`: a DirectionalLight of the scene, or null. Its intensity is irradiance across the light, as three.js has it.
/// - `environment`: SphericalHarmonics3 of radiance, as LightProbeGenerator computes from a cube map, or null.
/// - `crossings`: the `Crossings` of the strands, or null for strands that know nothing of each other.
/// - `lines`: true for `LineSegments`, false for ribbons.
/// - `leastWidth`: of a ribbon in pixels. Thinner ribbons are widened to it, and stay opaque.
///
/// Materials conserve energy: where the albedo exceeds 1 for a viewer, the hair is as bright as white light around it.
export class HairMaterial extends NodeMaterial {
  constructor(
    hairis,
    { source, dual },
    material,
    { light = null, environment = null, crossings = null, lines = false, leastWidth = 1 } = {},
  ) {
    super();
    this.hairis = hairis;
    this.model = material.model;
    this.light = light;
    this.environment = environment;
    const hit = hitFunction(source),
      model = hairis.kernel.model(material.model);
    this.constants = uniformArray(
      Array.from({ length: Math.ceil(hit.places.length / 4) }, () => new Vector4()),
      'vec4',
    );
    this.table = uniformArray(
      Array.from({ length: INCLINATIONS * ROWS }, () => new Vector4()),
      'vec4',
    );
    this.forward = uniform(new Vector3());
    const averages = hitFunction(dual, '_depth');
    this.averages = uniformArray(
      Array.from({ length: averages.places.length / 4 }, () => new Vector4()),
      'vec4',
    );
    /// Factors on light that other strands send on, and that they send back.
    this.gains = uniform(new Vector2(GAIN, GAIN));
    this.set(material);

    const tangent = lines
        ? attribute('tangent', 'vec3')
        : mix(attribute('startTangent', 'vec3'), attribute('stopTangent', 'vec3'), positionGeometry.x),
      along = normalize(modelWorldMatrix.mul(vec4(varying(tangent), 0)).xyz),
      view = normalize(cameraPosition.sub(positionWorld));
    const { across, pixels, radius } = lines
        ? { across: float(0), pixels: float(0), radius: attribute('radius', 'float') }
        : this.widen(tangent, leastWidth),
      includes = crossings ? [source, dual, multiple] : [source],
      direct = wgslFn(
        directSource(hit, model.near_field, crossings && averages),
        includes.map(text => wgsl(text)),
      );
    const toLight = uniform(new Vector3(0, 1, 0)).onObjectUpdate(({ object }) => this.aim(object, crossings)),
      irradiance = uniform(new Vector3()).onObjectUpdate(() => {
        const { light } = this;
        return light
          ? new Vector3(light.color.r, light.color.g, light.color.b).multiplyScalar(light.intensity)
          : new Vector3();
      });
    const args = Object.fromEntries(this.constants.array.map((_, i) => [`c${i}`, this.constants.element(i)]));
    if (crossings) this.averages.array.forEach((_, i) => (args[`d${i}`] = this.averages.element(i)));
    // Two neighbours in the table, and the place between them.
    const at = wgslFn(place)({ sine: dot(view, along) }),
      first = at.floor().min(INCLINATIONS - 2),
      rows = Array.from({ length: ROWS }, (_, row) =>
        [0, 1].map(side => this.table.element(first.add(side).mul(ROWS).add(row).toInt())),
      ),
      [...moments] = rows.map(([a, b]) => mix(a, b, at.sub(first)).xyz),
      factor = moments.pop();
    const quadratics = [0, 1, 2].map(c => uniform(new Matrix4()).onObjectUpdate(() => quadratic(this.environment, c)));
    let around = environmentFunction(...moments, ...quadratics, view, along);
    if (crossings) {
      const local = modelWorldMatrixInverse.mul(vec4(positionWorld, 1)).xyz,
        counts = texture3D(crossings.texture, local.sub(uniform(crossings.low)).div(crossings.side)),
        own = radius.mul(crossings.own);
      args.depth = counts.x.sub(own.mul(cross(along, toLight).length())).max(0);
      args.gains = this.gains;
      around = around.mul(wgslFn(dim)(this.forward, counts.y.sub(own.mul(Math.PI / 4)).max(0)));
    }
    const lit = direct({ ...args, view, along, across, pixels, pixel: screenCoordinate, toLight, factor });
    this.colorNode = lit.mul(irradiance).add(around);
  }

  /// Sets the parameters: `{ model, word, values }` as the module describes them, with fields by the names of `hairis eval`. The model must
  /// be that of the material. Throws an error that names a value which is refused.
  set(material) {
    if (material.model !== this.model)
      throw new Error(`model must be ${this.model}, that of the material, got ${material.model}`);
    const { kernel } = this.hairis,
      refusal = kernel.setMaterial(0, material);
    if (refusal) throw new Error(refusal);
    const { table, forward } = scattering(kernel, material);
    const numbers = kernel.work[0].slice(0, kernel.calls.constants(0));
    this.constants.array.forEach((four, i) => four.fromArray([0, 1, 2, 3].map(j => numbers[4 * i + j] ?? 0)));
    this.table.array.forEach((four, i) => four.fromArray(table, 4 * i));
    this.forward.value.fromArray(forward);
    kernel.calls.dual_scattering(0);
    this.averages.array.forEach((four, i) => four.fromArray(kernel.work[0], 4 * i));
  }

  /// Turns quads into ribbons that face the camera. Returns the place across the ribbon, from -1 to 1 along u x v, its width in
  /// pixels, and the radius of the strand.
  widen(tangent, leastWidth) {
    const node = mix(attribute('start', 'vec4'), attribute('stop', 'vec4'), positionGeometry.x),
      camera = modelWorldMatrixInverse.mul(vec4(cameraPosition, 1)).xyz,
      side = normalize(cross(tangent, camera.sub(node.xyz))),
      depth = modelViewMatrix.mul(vec4(node.xyz, 1)).z.negate(),
      // Of a mesh that is scaled, as in its own space.
      scale = modelWorldMatrix.mul(vec4(1, 0, 0, 0)).xyz.length(),
      pixel = depth.mul(2).div(cameraProjectionMatrix.element(1).y.mul(screenSize.y).mul(scale)).abs(),
      radius = node.w.max(pixel.mul(leastWidth / 2));
    this.positionNode = node.xyz.add(side.mul(positionGeometry.y.mul(radius)));
    return { across: varying(positionGeometry.y), pixels: varying(radius.div(pixel).mul(2)), radius: varying(node.w) };
  }

  /// The direction towards the light, for which it brings the crossings up to date.
  aim(object, crossings) {
    const { light } = this,
      direction = new Vector3(0, 1, 0);
    if (!light) return direction;
    direction
      .setFromMatrixPosition(light.matrixWorld)
      .sub(new Vector3().setFromMatrixPosition(light.target.matrixWorld))
      .normalize();
    crossings?.update(direction.clone().transformDirection(new Matrix4().copy(object.matrixWorld).invert()));
    return direction;
  }
}

/// Radiance towards the viewer under light that is quadratic in its direction: x Q x with x = (direction, 1), by channel.
const environmentFunction = wgslFn(`
fn hairis_around(total: vec3f, mu: vec3f, mv: vec3f, muu: vec3f, mvv: vec3f, muv: vec3f, red: mat4x4f, green: mat4x4f, blue: mat4x4f, view: vec3f, along: vec3f) -> vec3f {
  let across = view - dot(view, along) * along;
  let v = across / max(length(across), 1e-6);
  let w = cross(along, v);
  var q = array<mat4x4f, 3>(red, green, blue);
  var light = vec3f();
  for (var c = 0; c < 3; c++) {
    let one = q[c] * vec4f(0.0, 0.0, 0.0, 1.0);
    let qu = q[c] * vec4f(along, 0.0);
    let qv = q[c] * vec4f(v, 0.0);
    // The total is the sum of the moments by u u, v v and w w.
    let ww = dot(q[c] * vec4f(w, 0.0), vec4f(w, 0.0));
    light[c] = total[c] * (one.w + ww) + 2.0 * (mu[c] * dot(one.xyz, along) + mv[c] * dot(one.xyz, v) + muv[c] * dot(qu.xyz, v))
      + muu[c] * (dot(qu.xyz, along) - ww) + mvv[c] * (dot(qv.xyz, v) - ww);
  }
  return max(light, vec3f());
}`);

/// Width in pixels from which a ribbon shows the hit of each pixel. Narrower ribbons and lines show the mean over the fibre, of this many
/// offsets, one in each part of the fibre. Where in its part an offset lies depends on the pixel, because lobes are narrower than parts.
const NARROW = 3,
  PARTS = 4;

/// Light towards the viewer of one direction towards the light: S cos theta, or what stands in its place in hair. Constants of the model are in
/// parameters c0, c1..., and those of dual scattering in d0, d1...
function directSource({ call, type, places }, isNearField, dual) {
  const fours = (letter, places) =>
      Array.from({ length: Math.ceil(places.length / 4) }, (_, i) => `${letter}${i}: vec4f, `).join(''),
    copies = (variable, letter, places) =>
      places.map((place, at) => `  ${variable}.${place} = ${letter}${at >> 2}.${'xyzw'[at & 3]};`).join('\n');
  const value = h => `${call}(hair, wo, ${h}, wi).value`;
  // One call in a loop, because a call for each offset would be as many copies of the model.
  const mean = `
  let isNarrow = pixels < ${NARROW}.0;
  let parts = select(1, ${PARTS}, isNarrow);
  let within = fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715))));
  var sum = vec3f();
  for (var i = 0; i < parts; i++) {
    sum += ${value(`select(-across, 2.0 * (f32(i) + within) / ${PARTS}.0 - 1.0, isNarrow)`)} / f32(parts);
  }`;
  return `
fn hairis_direct(${fours('c', places)}${dual ? `${fours('d', dual.places)}depth: f32, gains: vec2f, ` : ''}view: vec3f, along: vec3f, across: f32, pixels: f32, pixel: vec2f, toLight: vec3f, factor: vec3f) -> vec3f {
  var hair: ${type};
${copies('hair', 'c', places)}
  let sine = dot(view, along);
  let side = view - sine * along;
  let cosine = max(length(side), 1e-6);
  let v = side / cosine;
  let wo = vec3f(sine, cosine, 0.0);
  let wi = vec3f(dot(toLight, along), dot(toLight, v), dot(toLight, cross(along, v)));
  ${isNearField ? mean : `let sum = ${value('0.0')};`}
  let single = factor * sum;
${dual ? `  var averages: ${dual.type};\n${copies('averages', 'd', dual.places)}` : ''}
  return ${dual ? 'hairis_multiple(averages, wo, wi, single, depth, gains)' : 'single'} * length(wi.yz);
}`;
}

/// The quadratic form of a channel of radiance in spherical harmonics of order 2, whose basis is that of three.js.
export function quadratic(harmonics, channel) {
  if (!(harmonics instanceof SphericalHarmonics3)) return new Matrix4().multiplyScalar(0);
  const l = harmonics.coefficients.map(color => color.getComponent(channel)),
    [a, b, c, d, e] = [0.282095, 0.488603, 1.092548, 0.315392, 0.546274];
  const constant = a * l[0] - d * l[6],
    [x, y, z] = [l[3], l[1], l[2]].map(one => (b * one) / 2),
    [xy, yz, xz] = [l[4], l[5], l[7]].map(one => (c * one) / 2);
  return new Matrix4().set(e * l[8], xy, xz, x, xy, -e * l[8], yz, y, xz, yz, 3 * d * l[6], z, x, y, z, constant);
}
