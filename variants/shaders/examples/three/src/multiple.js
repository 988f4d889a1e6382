/// The term of multiple scattering: how light is dimmed, coloured and spread by the strands between the light and a strand.
///
/// - `forward`: mean forward albedo of the hair, linear RGB in [0, 1]: the share of light that a strand scatters away from the light.
/// - `crossings`: expected number of strands between the light and the strand, from 0.
/// - Returns the transmitted share as RGB in xyz, and the variance of the transmitted directions in w, rad^2.
///
/// A ray meets N strands, and N is taken as Poisson with the mean `crossings`. The mean of forward^N is then
/// exp(-crossings (1 - forward)). Light that is scattered backward, or that comes from strands beside the ray, is missing, and the
/// transmitted light keeps its direction, so that w is 0. Dual scattering is another function with these arguments and results.
export const multiple = `
fn hairis_multiple(forward: vec3f, crossings: f32) -> vec4f {
  return vec4f(exp(-crossings * (1.0 - forward)), 0.0);
}`;
