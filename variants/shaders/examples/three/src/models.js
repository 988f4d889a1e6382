/// Models of hair: the module that computes constants, and generated sources.
import { Kernel } from '#page';

/// The models, from a folder with `hairis.wasm` and a `.wgsl` of each.
export class Models {
  static async load(folder = './') {
    const hairis = new this();
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
}

/// What a generated source declares: the function of a hit with the given ending, and the struct of constants with its fields in order.
export function hitFunction(source, ending = '_hit\\w*') {
  const [, call, type] = source.match(new RegExp(`fn (hairis_\\w+${ending})\\(material: (\\w+)`)),
    [, body] = source.match(new RegExp(`struct ${type} \\{([^}]*)\\}`));
  // A field is a number, or an array of numbers.
  const places = Array.from(body.matchAll(/(\w+): (?:array<f32, (\d+)>|f32)/g), ([, name, size]) =>
    size ? Array.from({ length: +size }, (_, i) => `${name}[${i}]`) : [name],
  ).flat();
  return { call, type, places };
}
