// Types of hairis-three for TypeScript, on standard output: types.mjs hairis.wasm. Fields of models are those that the module describes.
import { readFileSync } from 'node:fs';

const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), {}),
  { describe, text, memory } = instance.exports,
  length = describe(),
  { models } = JSON.parse(new TextDecoder().decode(new Uint8Array(memory.buffer, text(), length)));

const kinds = {
  number: () => 'number',
  rgb: () => 'RGB',
  numbers: ({ words }) => `[${words.map(word => `${word.toLowerCase()}: number`).join(', ')}]`,
  word: ({ words }) => words.map(word => `'${word}'`).join(' | '),
};
const field = one => {
  const [least, most] = one.range ?? [],
    range =
      one.range && (most > 1e30 ? `, at least ${least}` : `, in [${+least.toPrecision(4)}, ${+most.toPrecision(4)}]`);
  const isOptional =
    one.optional ||
    one.instead_of ||
    models.some(({ fields }) => fields.includes(one) && fields.some(other => other.instead_of === one.name));
  const instead = one.instead_of ? `, in place of ${one.instead_of}` : '';
  return `    /** ${one.doc.replace(/[.]$/, '')}${one.unit && `, ${one.unit}`}${range ?? ''}${instead} */\n    ${one.name}${isOptional ? '?' : ''}: ${kinds[one.kind](one)};`;
};

console.log(`import type { BufferGeometry, Data3DTexture, DirectionalLight, InstancedBufferGeometry, NodeMaterial, Sphere, SphericalHarmonics3, Vector2, Vector3 } from 'three/webgpu';

/** Linear red, green and blue. */
export type RGB = [number, number, number];

/** Fields of each model by the names of \`hairis eval\`. */
export interface Models {
${models.map(({ name, fields }) => `  '${name}': {\n${fields.map(field).join('\n')}\n  };`).join('\n')}
}

/** Names of presets of each model. */
export interface Presets {
${models
  .map(
    ({ name, presets }) =>
      `  '${name}': ${Object.keys(presets)
        .map(preset => `'${preset}'`)
        .join(' | ')};`,
  )
  .join('\n')}
}

export interface Options {
  /** A light of the scene; its intensity is irradiance across the light. */
  light?: DirectionalLight | null;
  /** Radiance from all around. */
  environment?: SphericalHarmonics3 | null;
  /** Strands between a place and the light; without it strands know nothing of each other. */
  crossings?: Crossings | null;
  /** For \`LineSegments\` in place of ribbons. */
  lines?: boolean;
  /** Least width of a ribbon in pixels, 1 unless it is given. */
  leastWidth?: number;
}

export class Hairis {
  /** Loads the module of the models; \`folder\` has \`hairis.wasm\` and a \`.wgsl\` of each model, and ends with a slash. */
  static load(folder?: string): Promise<Hairis>;
  readonly models: (keyof Models)[];
  presets<M extends keyof Models>(model: M): Record<Presets[M], Models[M]>;
  material<M extends keyof Models>(model: M, values: Models[M] | Presets[M], options?: Options): Promise<HairMaterial<M>>;
}

export class HairMaterial<M extends keyof Models = keyof Models> extends NodeMaterial {
  light: DirectionalLight | null;
  environment: SphericalHarmonics3 | null;
  /** Factors on light that other strands send on and that they send back: 1.15 both. */
  readonly gains: { value: Vector2 };
  /** Other parameters of the same model. Throws an error that names a value which is refused. */
  set(material: { model: M; values: Models[M] }): void;
}

export class Strands {
  /** \`nodes\`: x, y, z and radius of each node; \`ends[i]\`: number of nodes up to the end of strand i. */
  constructor(nodes: Float32Array, ends: Uint32Array);
  /** Reads cyHair (\`.hair\`). */
  static read(buffer: ArrayBuffer): Strands;
  every(step: number, wider?: number): Strands;
  readonly box: { low: number[]; high: number[] };
}

export class Crossings {
  /** \`size\`: cells along each side of the volume, 48 unless it is given. */
  constructor(strands: Strands, size?: number);
  readonly texture: Data3DTexture;
  /** Crossings towards a light, a unit vector in the space of the strands. The material calls it for its light. */
  update(light: Vector3): void;
}

/** The sphere around the box of all strands. */
export function sphereOf(strands: Strands): Sphere;
/** Ribbons that face the camera, for a Mesh. */
export function ribbons(strands: Strands): InstancedBufferGeometry;
/** Lines for LineSegments. */
export function lines(strands: Strands): BufferGeometry;`);
