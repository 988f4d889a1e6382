/// Multiple scattering: what light becomes on its way through hair, in WGSL behind the generated source of dual scattering.

/// - `hairis_multiple`: the value that stands in place of S (`single`), for a directional light. `hair` are the averages of the material, `depth`
///   is the mean number of strands between the hit and the light, and `gains` scale what other strands send on and send back.
/// - `hairis_dim`: the share of light from all around that passes so many strands, of a mean forward albedo, linear RGB. A ray meets N strands,
///   and N is taken as Poisson with the mean `depth`: the mean of forward^N is exp(-depth (1 - forward)).
export const multiple = `
fn hairis_multiple(hair: HairisDualScatteringMaterial, wo: vec3f, wi: vec3f, single: vec3f, depth: f32, gains: vec2f) -> vec3f {
  let crossed = hairis_dual_scattering_depth(hair, asin(clamp(wi.x, -1.0, 1.0)), depth);
  return hairis_dual_scattering_shade(hair, wo, wi, single, crossed, gains.x, gains.y).value;
}`;

export const dim = `
fn hairis_dim(forward: vec3f, depth: f32) -> vec3f {
  return exp(-depth * (1.0 - forward));
}`;

/// Factors of both parts, fitted once to paths of any length: GAIN of the library.
export const GAIN = 1.15;
