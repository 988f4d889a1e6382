// What the page shows: one object, which a link restores and undo steps through.

let state,
  past = [],
  future = [];

/// A field of the state: its first value, the rule in words, and whether a value keeps to it.
const field = (first, rule, allows) => ({
  first,
  rule,
  allows,
  read(value, path) {
    if (!allows(value)) throw refused(path, rule, value);
    return value;
  },
});
const between = (least, most, first) => ({
  ...field(
    first,
    `a number in [${least}, ${most}]`,
    value => typeof value === 'number' && value >= least && value <= most,
  ),
  least,
  most,
});
const oneOf = (...values) => field(values[0], `one of ${values.map(said).join(', ')}`, value => values.includes(value));

const described = slot => ({
  get first() {
    return newMaterial(kernel.models[slot]);
  },
  read: readMaterial,
});

/// What the page shows, and every value that it may have. The first values are the first view: the Gaussian model beside the all-Cauchy
/// one, on the material that the project's figures are of. Links are written and read by this description, and controls keep to it.
const STATE = {
  materials: [described(0), described(1)],
  linked: oneOf(true, false),
  tab: oneOf(0, 1),
  lobes: field(15, 'a whole number in [0, 15]', value => Number.isInteger(value) && value >= 0 && value <= 15),
  show: oneOf('value', 'color', 'pdf'),
  scale: oneOf('log', 'linear'),
  samples: oneOf(false, true),
  view: { theta: between(-90, 90, 45), h: between(-1, 1, 0.3) },
  cut: { theta: between(-90, 90, -45), phi: between(-180, 180, 0) },
  turn: [between(-Math.PI, Math.PI, -0.6), between(-1.5, 1.5, 0.35)],
  light: { turn: between(-360, 360, 0), exposure: between(-24, 24, 0) },
  camera: [between(-Math.PI, Math.PI, 0.5), between(-1.2, 1.2, 0.15)],
};

/// Two angles of the state after a drag: the first goes around, the second stops at its ends.
const dragged = ([around, up], [x, y], [, { least, most }]) => [
  around + x - 2 * Math.PI * Math.round((around + x) / (2 * Math.PI)),
  Math.max(least, Math.min(most, up + y)),
];

const initialState = () => read(STATE);

/// A value in a refusal, cut where it is long.
function said(value) {
  const text = typeof value === 'number' ? `${value}` : (JSON.stringify(value) ?? 'nothing');
  return text.length > 60 ? `${text.slice(0, 60)}…` : text;
}
const refused = (path, rule, value) => new Error(`${path} must be ${rule}, got ${said(value)}`);
const isObject = value => typeof value === 'object' && value !== null && !Array.isArray(value);

/// Throws for a value that is no object, or that has a field that is none of `names`.
function checkNames(value, names, path) {
  if (!isObject(value)) throw refused(path || 'the state', 'an object', value);
  const other = Object.keys(value).find(name => !names.includes(name));
  if (other !== undefined)
    throw new Error(
      `${path && `${path}.`}${said(other).slice(1, -1)}: unknown field, expected one of ${names.join(', ')}`,
    );
}

/// A value by its description: what is missing is as in the first view. Throws a sentence on what is not described or not allowed.
function read(like, given, path = '') {
  if (like.read) return given === undefined ? like.first : like.read(given, path);
  if (Array.isArray(like)) {
    if (given !== undefined && !(Array.isArray(given) && given.length === like.length))
      throw refused(path, `a list of ${like.length}`, given);
    return like.map((entry, place) => read(entry, given?.[place], `${path}[${place}]`));
  }
  const names = Object.keys(like);
  if (given !== undefined) checkNames(given, names, path);
  return Object.fromEntries(
    names.map(name => [name, read(like[name], given?.[name], path ? `${path}.${name}` : name)]),
  );
}

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

const link = () => `#${encodeURIComponent(JSON.stringify(read(STATE, state)))}`;

/// The state of an address, or a sentence that says why there is none.
function readLink(hash) {
  if (hash.length < 2) return { state: initialState() };
  try {
    const found = read(STATE, JSON.parse(decodeURIComponent(hash.slice(1))));
    found.materials.forEach((material, slot) => accept(slot, material, `materials[${slot}].`));
    return { state: found };
  } catch (error) {
    return {
      state: initialState(),
      refusal: `The link was not read: ${error.message}. The page shows its first view.`,
    };
  }
}

/// Gives the module a material, by its values and then by an artist's controls. Throws what it refuses.
function accept(slot, material, path) {
  for (const one of [{ ...material, artist: null }, material]) {
    const refusal = kernel.setMaterial(slot, one);
    if (refusal) throw new Error(`${path}${one.artist ? 'artist.' : path && 'values.'}${refusal}`);
  }
}

/// A material by the module's description. A model without a choice takes the word of any other.
function readMaterial(given, path) {
  checkNames(given, ['model', 'word', 'values', 'artist'], path);
  const model = kernel.model(given.model);
  if (!model) throw refused(`${path}.model`, `one of ${kernel.models.map(({ name }) => name).join(', ')}`, given.model);
  const words = (model.choice ? model : kernel).entries.map(({ word }) => word),
    { word = words[0], values, artist = null } = given;
  if (!words.includes(word)) throw refused(`${path}.word`, `one of ${words.filter(Boolean).join(', ')}`, word);
  readValues(model.fields, values, `${path}.values`);
  if (artist && model.artist) readValues(kernel.artist, artist, `${path}.artist`);
  else if (artist !== null)
    throw refused(`${path}.artist`, model.artist ? 'an object or null' : `null for ${model.name}`, artist);
  return { model: model.name, word, values, artist };
}

/// Checks values by the fields that they are of, as `hairis eval` does.
function readValues(fields, values, path) {
  if (values === undefined) throw new Error(`${path}: missing`);
  checkNames(
    values,
    fields.map(({ name }) => name),
    path,
  );
  for (const field of fields) {
    const value = values[field.name],
      at = `${path}.${field.name}`,
      width = widthOf(field);
    if (!field.instead_of) {
      const group = fields.filter(other => other.name === field.name || other.instead_of === field.name),
        [first, second] = group.filter(other => values[other.name] !== undefined);
      if (!first && !field.optional) throw new Error(`${at}: missing`);
      if (second) throw new Error(`${path}.${first.name}: given together with ${second.name}; give one of them`);
    }
    if (value === undefined) continue;
    if (field.kind === 'word') {
      if (!field.words.includes(value)) throw refused(at, `one of ${field.words.join(', ')}`, value);
    } else if (
      width > 1
        ? !(Array.isArray(value) && value.length === width && value.every(Number.isFinite))
        : !Number.isFinite(value)
    ) {
      throw refused(at, width > 1 ? `${width} numbers` : 'a number', value);
    }
  }
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

/// The inclination of a direction, which has the length 1 as in `hairis eval`.
function inclination(wo) {
  if (!(Array.isArray(wo) && wo.length === 3 && Math.abs(Math.hypot(...wo) - 1) <= 1e-3))
    throw refused('wo', 'a unit vector', wo);
  return Math.asin(wo[0] / Math.hypot(...wo)) / RAD;
}

/// Takes a request of `hairis eval` as a slot's material; a refusal as text, or nothing.
function takeRequest(text, slot) {
  try {
    const given = JSON.parse(text),
      model = kernel.model(given?.model);
    if (!isObject(given)) throw refused('the request', 'an object', given);
    if (!model) throw refused('model', `one of ${kernel.models.map(({ name }) => name).join(', ')}`, given.model);
    const { choice, near_field } = model,
      known = ['model', choice, 'params', 'wo', near_field && 'h', 'wi', 'xi'].filter(Boolean);
    checkNames(given, known, '');
    const words = model.entries.map(({ word }) => word),
      { [choice]: word = words[0], params, wo, h } = given;
    if (!words.includes(word)) throw refused(choice, `one of ${words.join(', ')}`, word);
    readValues(model.fields, params, 'params');
    const view = { ...state.view };
    if (h !== undefined) view.h = STATE.view.h.read(h, 'h');
    if (wo !== undefined) view.theta = inclination(wo);
    const material = { model: model.name, word, values: params, artist: null };
    accept(slot, material, '');
    Object.assign(state, { linked: false, view });
    state.materials[1 - slot] = materialOf(1 - slot);
    state.materials[slot] = material;
    return '';
  } catch (error) {
    return error instanceof SyntaxError ? `The JSON was not read: ${error.message}.` : error.message;
  }
}
