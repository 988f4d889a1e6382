/// A sky as spherical harmonics of radiance: a mean, and more light from above and from the viewer's left.
import { SphericalHarmonics3 } from 'three/webgpu';

export function sky(brightness) {
  const harmonics = new SphericalHarmonics3(),
    mean = 2 * Math.sqrt(Math.PI) * brightness;
  [
    [0.55, 0.66, 0.82],
    [0.24, 0.32, 0.44],
    [0.1, 0.1, 0.1],
    [-0.1, -0.08, -0.05],
  ].forEach((color, i) => harmonics.coefficients[i].fromArray(color.map(x => x * mean)));
  return harmonics;
}
