// Materials by their fields: every field of a model as the module describes it, with its controls.

function newMaterial(model) {
  const [name] = Object.keys(model.presets);
  return { model: model.name, word: model.entries[0].word, values: structuredClone(model.presets[name]), artist: null };
}

const isSame = (a, b) => JSON.stringify(a) === JSON.stringify(b);

/// Range of a field's slider: that of random materials, widened; within what is accepted.
function sliderRange({ range: [least, most], draw, log }) {
  if (!draw) return most < 1e6 ? [least, most] : [0, 3];
  const [lo, hi] = log
    ? [draw[0] / 4, draw[1] * 4]
    : [draw[0] - (draw[1] - draw[0]) / 2, draw[1] + (draw[1] - draw[0]) / 2];
  return [Math.max(lo, least), Math.min(hi, most)];
}

/// Where a material starts from: the choice of its preset, "edited" where it is none, and, for models that artists have controls of, the terms
/// in which it is given. `setPreset` takes a name, and `setTerms` whether the artist's controls are wanted.
function startRows(model, material, setPreset, setTerms) {
  const presets = Object.keys(model.presets),
    current = presets.find(name => !material.artist && isSame(model.presets[name], material.values));
  return [
    choice(
      'preset',
      [...(current ? [] : [{ value: '', text: 'edited' }]), ...presets.map(value => ({ value }))],
      current ?? '',
      name => {
        if (name) setPreset(name);
      },
    ),
    model.artist
      ? buttons(
          'Terms',
          [
            [false, 'Parameters'],
            [true, 'Artist’s controls'],
          ],
          Boolean(material.artist),
          setTerms,
        )
      : null,
  ];
}

/// The controls of one field.
function fieldRows(field, material) {
  const { values } = material,
    unit = field.unit === 'rad' ? '°' : '',
    by = unit ? RAD : 1;
  const put = value => {
    const before = values[field.name];
    values[field.name] = value;
    const refused = changed();
    if (refused) values[field.name] = before;
    return refused;
  };
  if (field.kind === 'word')
    return [
      choice(
        field.name,
        field.words.map(value => ({ value })),
        values[field.name] ?? field.words[0],
        value => {
          put(value);
          commit();
        },
      ),
    ];
  const [least, most] = field.range.map(x => x / by);
  const limits = `${+least.toPrecision(3)} to ${most > 1e30 ? 'any size' : +most.toPrecision(4)}${unit}`;
  if (field.kind === 'rgb')
    return [
      colorRow({
        label: field.name,
        title: field.doc,
        most: Math.min(field.range[1], field.log ? field.draw[1] : field.draw ? field.draw[1] * 2 : 1),
        get: () => values[field.name],
        set: put,
      }),
    ];
  const range = sliderRange(field).map(x => x / by),
    several = field.kind === 'numbers';
  return (several ? field.words : ['']).map((word, place) =>
    slider({
      label: several ? `${field.name} ${word}` : field.name,
      unit,
      title: field.doc,
      range,
      log: field.log,
      limits,
      get: () => (several ? values[field.name][place] : values[field.name]) / by,
      set: shown => put(several ? values[field.name].with(place, shortest(shown * by)) : shortest(shown * by)),
    }),
  );
}

/// The controls of a material: its fields, of which some stand for others, or an artist's.
function materialRows(material) {
  const model = kernel.model(material.model);
  if (material.artist) return artistRows(material);
  return model.fields.flatMap(field => {
    const group = model.fields.filter(other => (other.instead_of ?? other.name) === (field.instead_of ?? field.name));
    if (group.length === 1) {
      const usual = Object.values(model.presets)[0][field.name];
      if (material.values[field.name] === undefined) material.values[field.name] = structuredClone(usual);
      // Tints, factors on widths and pigments have controls in materials that use them: from a link or a file.
      if (field.optional && !field.draw && field.kind !== 'word' && `${material.values[field.name]}` === `${usual}`) return [];
      return fieldRows(field, material);
    }
    if (field !== group[0]) return [];
    const given = group.find(other => material.values[other.name] !== undefined) ?? group[0];
    const select = choice(
      `${group[0].name} by`,
      group.map(other => ({ value: other.name })),
      given.name,
      name => {
        replace(
          material,
          model,
          given,
          group.find(other => other.name === name),
        );
        build();
        changed();
        commit();
      },
    );
    return [select, ...fieldRows(given, material)];
  });
}

/// Gives one field of a group in place of another: what the module has made of it where it can be, else the middle of its range.
function replace(material, model, given, next) {
  const effective = kernel.setMaterial(0, material) ? {} : kernel.readValues(model);
  delete material.values[given.name];
  const most = Math.min(1, next.range[1]) / 2,
    width = widthOf(next);
  material.values[next.name] = effective[next.name] ?? (width > 1 ? Array(width).fill(most) : most);
}

function artistRows(material) {
  let group = '';
  return kernel.artist.flatMap(control => {
    const { artist } = material,
      [part, name] = control.name.split('.');
    const put = value => {
      const before = artist[control.name];
      artist[control.name] = value;
      const refused = changed();
      if (refused) artist[control.name] = before;
      return refused;
    };
    const title = group === part ? [] : [make('p', { class: 'title' }, part[0].toUpperCase() + part.slice(1))];
    group = part;
    const label = name.replace('_deg', '').replaceAll('_', ' ');
    return [
      ...title,
      control.kind === 'rgb'
        ? colorRow({ label, title: control.name, most: 1, get: () => artist[control.name], set: put })
        : slider({
            label,
            unit: control.unit && '°',
            title: control.name,
            range: control.range,
            get: () => artist[control.name],
            set: put,
          }),
    ];
  });
}
