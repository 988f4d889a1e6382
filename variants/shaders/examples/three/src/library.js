/// Models of hair for three.js: the module that computes constants, the generated sources, and the materials of both.
import { Kernel } from '#page';
import { HairMaterial } from './material.js';

export { Crossings } from './crossings.js';
export { HairMaterial } from './material.js';
export { Strands, lines, ribbons } from './strands.js';

/// The models, from a folder with `hairis.wasm` and a `.wgsl` of each.
export class Hairis {
  static async load(folder = './') {
    const hairis = new Hairis();
    hairis.folder = folder;
    hairis.sources = {};
    hairis.kernel = await Kernel.load(`${folder}hairis.wasm`);
    return hairis;
  }

  /// Names of the models.
  get models() {
    return this.kernel.models.map(({ name }) => name);
  }

  /// Presets of a model by name, each with the values of its fields.
  presets(model) {
    return this.description(model).presets;
  }

  /// The module's description of a model: fields with their units, ranges and words, and presets.
  description(model) {
    const found = this.kernel.model(model);
    if (!found) throw new Error(`model must be one of ${this.models.join(', ')}, got ${model}`);
    return found;
  }

  /// The generated WGSL of a model, `.wgsl` or another ending of its file.
  source(model, ending = '.wgsl') {
    return (this.sources[model + ending] ??= fetch(this.folder + model + ending).then(answer => {
      if (!answer.ok) throw new Error(`${model}${ending} must be beside hairis.wasm, got ${answer.status}`);
      return answer.text();
    }));
  }

  /// A material of a model: `values` by the names of `hairis eval`, or the name of a preset.
  async material(model, values, options) {
    const description = this.description(model);
    if (typeof values === 'string') {
      const preset = description.presets[values];
      if (!preset) throw new Error(`preset of ${model} must be one of ${Object.keys(description.presets).join(', ')}, got ${values}`);
      values = preset;
    }
    return new HairMaterial(this, await this.source(model), { model, values }, options);
  }
}
