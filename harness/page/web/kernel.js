// The module of the kernels: its memory as arrays, and its calls.
'use strict';

const WIDTH = 512,
  HEIGHT = 256,
  RAD = Math.PI / 180;
let kernel;

class Kernel {
  constructor(exports) {
    this.calls = exports;
    const length = exports.describe();
    const list = JSON.parse(this.text(length));
    this.models = list.models;
    this.artist = list.artist;
    this.column = list.column;
    const floats = (at, count) => new Float32Array(exports.memory.buffer, at, count);
    const columns = (at, count) =>
      Array.from({ length: count }, (_, i) => floats(at + 4 * i * this.column, this.column));
    this.numbers = floats(exports.numbers(), 48);
    this.maps = [0, 1].map(slot => columns(exports.map(slot), 7));
    this.work = columns(exports.work(), 14);
    this.entries = [];
    for (const model of this.models)
      for (const entry of model.entries) this.entries[entry.model] = { ...entry, of: model };
  }

  static async load(address) {
    const response = await fetch(address);
    if (!response.ok)
      throw new Error(`${address} must be beside the page, got ${response.status}; build the page again`);
    const { instance } = await WebAssembly.instantiate(await response.arrayBuffer(), {});
    return new Kernel(instance.exports);
  }

  text(length) {
    return new TextDecoder().decode(new Uint8Array(this.calls.memory.buffer, this.calls.text(), length));
  }

  model(name) {
    return this.models.find(model => model.name === name);
  }

  /// Entry of a model's list for a word of its choice.
  entry(material) {
    const { entries } = this.model(material.model);
    return entries.find(entry => entry.word === material.word) ?? entries[0];
  }

  /// Sets the material of a slot; a refusal as text, or nothing.
  setMaterial(slot, material) {
    const model = this.model(material.model);
    let given = 0,
      at = 0;
    if (material.artist && model.artist) {
      const refusal = this.fromArtist(material.artist);
      if (refusal) return refusal;
      given = 2 ** model.fields.length - 1;
    } else {
      model.fields.forEach((field, index) => {
        const value = material.values[field.name],
          width = widthOf(field);
        if (value !== undefined) {
          given |= 1 << index;
          const numbers = field.kind === 'word' ? [field.words.indexOf(value)] : [value].flat();
          for (let i = 0; i < width; i++) this.numbers[at + i] = numbers[i];
        }
        at += width;
      });
    }
    const length = this.calls.set_material(slot, this.entry(material).model, given);
    return length ? this.text(length) : '';
  }

  /// The numbers of the fields that an artist's controls describe, left in `numbers`; a refusal as text, or nothing.
  fromArtist(controls) {
    let at = 0;
    for (const control of this.artist)
      for (const number of [controls[control.name]].flat()) this.numbers[at++] = number;
    const length = this.calls.from_artist();
    return length ? this.text(length) : '';
  }

  /// Values of the fields in `numbers`, as JSON has them.
  readValues(model) {
    const values = {};
    let at = 0;
    for (const field of model.fields) {
      const width = widthOf(field);
      if (!field.instead_of) {
        const numbers = Array.from(this.numbers.subarray(at, at + width), shortest);
        values[field.name] = field.kind === 'word' ? field.words[numbers[0]] : width > 1 ? numbers : numbers[0];
      }
      at += width;
    }
    return values;
  }

  /// The controls of the material of a slot.
  toArtist(slot) {
    this.calls.to_artist(slot);
    let at = 0;
    const take = () => +this.numbers[at++].toPrecision(6);
    return Object.fromEntries(
      this.artist.map(({ name, kind }) => [name, kind === 'rgb' ? [take(), take(), take()] : take()]),
    );
  }

  setView(slot, view, lobes) {
    const [x, y, z] = wo(view.theta);
    this.calls.set_view(slot, x, y, z, view.h, lobes);
  }
}

const widthOf = field => (field.kind === 'rgb' ? 3 : field.kind === 'numbers' ? field.words.length : 1);

/// The direction towards the viewer at an inclination in degrees.
const wo = theta => direction(theta, 0);

/// The direction at an inclination and an azimuth in degrees.
function direction(theta, phi) {
  const cos = Math.cos(theta * RAD);
  return [Math.sin(theta * RAD), cos * Math.cos(phi * RAD), cos * Math.sin(phi * RAD)];
}

/// The number of fewest digits that is the same in single precision.
function shortest(number) {
  for (let digits = 1; digits < 9; digits++) {
    const short = +number.toPrecision(digits);
    if (Math.fround(short) === Math.fround(number)) return short;
  }
  return number;
}
