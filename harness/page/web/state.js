// What the page shows: one object, which a link restores and undo steps through.

let state,
  past = [],
  future = [];

/// The first view: the Gaussian model beside the all-Cauchy one, on the material that the project's figures are of.
function initialState() {
  const [a, b] = [kernel.models[0], kernel.models[1]].map(model => newMaterial(model));
  return {
    materials: [a, b],
    linked: true,
    tab: 0,
    lobes: 15,
    show: 'value',
    scale: 'log',
    samples: false,
    view: { theta: 45, h: 0.3 },
    cut: { theta: -45, phi: 0 },
    turn: [-0.6, 0.35],
    light: { turn: 0, exposure: 0 },
    camera: [0.5, 0.15],
  };
}

function newMaterial(model) {
  const [name] = Object.keys(model.presets);
  return { model: model.name, word: model.entries[0].word, values: structuredClone(model.presets[name]), artist: null };
}

const isSame = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const haveSameFields = () => {
  const [a, b] = state.materials.map(material => kernel.model(material.model));
  return isSame(a.fields, b.fields);
};
const isLinked = () => state.linked && haveSameFields();

/// The material of a slot: that of the first, if both are linked.
function materialOf(slot) {
  const own = state.materials[slot];
  return slot && isLinked() ? { ...own, values: state.materials[0].values, artist: state.materials[0].artist } : own;
}

/// The material whose fields the controls of a tab change.
const edited = () => state.materials[isLinked() ? 0 : state.tab];

/// Keeps the state as a step to return to, and in the address.
function commit() {
  const text = JSON.stringify(state);
  if (past.at(-1) === text) return;
  past.push(text);
  if (past.length > 200) past.shift();
  future = [];
  history.replaceState(null, '', link());
}

/// Moves the last step from one list to the other, and takes the step that is then last of the past.
function move(from, to) {
  if (from.length <= (from === past ? 1 : 0)) return false;
  to.push(from.pop());
  state = JSON.parse(past.at(-1));
  history.replaceState(null, '', link());
  return true;
}

const link = () => `#${encodeURIComponent(JSON.stringify(state))}`;

/// The state of an address, or a sentence that says why there is none.
function readLink(hash) {
  if (hash.length < 2) return { state: initialState() };
  try {
    const found = { ...initialState(), ...JSON.parse(decodeURIComponent(hash.slice(1))) };
    if (!Array.isArray(found.materials) || found.materials.length !== 2) throw new Error('it has no two materials');
    found.materials.forEach((material, slot) => {
      if (!kernel.model(material?.model)) throw new Error(`there is no model ${JSON.stringify(material?.model)}`);
      const refusal = checkMaterial(material) || kernel.setMaterial(slot, material);
      if (refusal) throw new Error(refusal);
    });
    const { materials, ...rest } = initialState();
    for (const [name, like] of Object.entries(rest))
      if (!isLike(found[name], like))
        throw new Error(`${name} must be like ${JSON.stringify(like)}, got ${JSON.stringify(found[name])}`);
    for (const [name, value, most] of [
      ['view.theta', found.view.theta, 90],
      ['view.h', found.view.h, 1],
      ['cut.theta', found.cut.theta, 90],
      ['cut.phi', found.cut.phi, 180],
    ])
      if (!(Math.abs(value) <= most)) throw new Error(`${name} must be in [-${most}, ${most}], got ${value}`);
    return { state: found };
  } catch (error) {
    return {
      state: initialState(),
      refusal: `The link was not read: ${error.message}. The page shows its first view.`,
    };
  }
}

/// Whether a value has the shape of another: the same type, and the same entries.
function isLike(value, like) {
  if (typeof like !== 'object')
    return typeof value === typeof like && (typeof like !== 'number' || Number.isFinite(value));
  return (
    typeof value === 'object' &&
    value !== null &&
    Object.entries(like).every(([name, entry]) => isLike(value[name], entry))
  );
}

/// Checks the shape of values; a refusal as text, or nothing.
function checkMaterial({ model, values, artist }) {
  const { fields } = kernel.model(model);
  if (artist) {
    for (const { name, kind } of kernel.artist)
      if ([artist[name]].flat().length !== (kind === 'rgb' ? 3 : 1) || ![artist[name]].flat().every(Number.isFinite))
        return `${name} must be ${kind === 'rgb' ? 'three numbers' : 'a number'}, got ${JSON.stringify(artist[name])}`;
    return '';
  }
  for (const name of Object.keys(values ?? {}))
    if (!fields.some(field => field.name === name))
      return `${name}: unknown field, expected one of ${fields.map(field => field.name).join(', ')}`;
  for (const field of fields) {
    const value = values?.[field.name],
      width = widthOf(field);
    const group = fields.filter(other => other.name === field.name || other.instead_of === field.name);
    if (value === undefined) {
      if (!field.optional && !field.instead_of && !group.some(other => values?.[other.name] !== undefined))
        return `${field.name}: missing`;
    } else if (field.kind === 'word') {
      if (!field.words.includes(value))
        return `${field.name} must be one of ${field.words.join(', ')}, got ${JSON.stringify(value)}`;
    } else if (!(
      [value].flat().length === width &&
      [value].flat().every(number => typeof number === 'number' && Number.isFinite(number))
    )) {
      return `${field.name} must be ${width > 1 ? `${width} numbers` : 'a number'}, got ${JSON.stringify(value)}`;
    }
  }
  return '';
}

/// A request of `hairis eval` for a slot: its answer is that of the readout.
function request(slot) {
  const material = materialOf(slot),
    model = kernel.model(material.model),
    params = fieldsOf(material, slot);
  return {
    model: material.model,
    ...(model.choice && { [model.choice]: kernel.entry(material).word }),
    params,
    wo: wo(state.view.theta),
    ...(model.near_field && { h: state.view.h }),
    wi: direction(state.cut.theta, state.cut.phi),
  };
}

/// Values of the fields, also of a material in an artist's terms.
function fieldsOf(material, slot) {
  if (!material.artist) return material.values;
  return kernel.setMaterial(slot, material) ? material.values : kernel.readValues(kernel.model(material.model));
}

/// Takes a request of `hairis eval` as a slot's material; a refusal as text, or nothing.
function takeRequest(text, slot) {
  let given;
  try {
    given = JSON.parse(text);
  } catch (error) {
    return `The JSON was not read: ${error.message}.`;
  }
  const model = kernel.model(given?.model);
  if (!model)
    return `model must be one of ${kernel.models.map(({ name }) => name).join(', ')}, got ${JSON.stringify(given?.model)}`;
  const word = model.choice && given[model.choice];
  const entry = model.entries.find(one => one.word === (word ?? model.entries[0].word));
  if (!entry)
    return `${model.choice} must be one of ${model.entries.map(one => one.word).join(', ')}, got ${JSON.stringify(word)}`;
  const material = { model: model.name, word: entry.word, values: given.params, artist: null };
  const refusal = checkMaterial(material) || kernel.setMaterial(slot, material);
  if (refusal) return refusal;
  state.linked = false;
  state.materials[1 - slot] = materialOf(1 - slot);
  state.materials[slot] = material;
  if (typeof given.h === 'number' && Math.abs(given.h) <= 1) state.view.h = given.h;
  if (Array.isArray(given.wo) && Math.abs(given.wo[0]) <= 1) state.view.theta = Math.asin(given.wo[0]) / RAD;
  return '';
}
