/// Hair for three.js.
import { HairMaterial } from './material.js';
import { Models } from './models.js';

export { Crossings } from './crossings.js';
export { HairMaterial } from './material.js';
export { lines, ribbons, sphereOf } from './geometry.js';
export { Strands } from './strands.js';

/// The models, which make materials for three.js.
export class Hairis extends Models {
  /// A material of a model: `values` by the names of `hairis eval`, or the name of a preset.
  async material(model, values, options) {
    const description = this.description(model);
    if (typeof values === 'string') {
      const preset = description.presets[values];
      if (!preset)
        throw new Error(
          `preset of ${model} must be one of ${Object.keys(description.presets).join(', ')}, got ${values}`,
        );
      values = preset;
    }
    const [source, dual] = await Promise.all([this.source(model), this.source('dual-scattering')]);
    return new HairMaterial(this, { source, dual }, { model, values }, options);
  }
}
