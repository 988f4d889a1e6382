// Controls: every field of a model as the module describes it.

/// Range of a field's slider: that of random materials, widened; within what is accepted.
function sliderRange({ range: [least, most], draw, log }) {
  if (!draw) return most < 1e6 ? [least, most] : [0, 3];
  const [lo, hi] = log
    ? [draw[0] / 4, draw[1] * 4]
    : [draw[0] - (draw[1] - draw[0]) / 2, draw[1] + (draw[1] - draw[0]) / 2];
  return [Math.max(lo, least), Math.min(hi, most)];
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

/// Every control anew.
function build() {
  buildTuftControls();
  const legend = (text, small) => make('legend', {}, text, small ? make('small', {}, ` ${small}`) : null);
  const models = [0, 1].map(slot => kernel.model(state.materials[slot].model)),
    near = models.some(model => model.near_field);
  const angle = (of, name, shown) =>
    slider({
      ...shown,
      ...limited(STATE[of][name], shown.label, value => {
        state[of][name] = value;
        return changed();
      }),
      get: () => state[of][name],
    });
  const lobes = models[0].lobes.length >= models[1].lobes.length ? models[0].lobes : models[1].lobes;
  fill(
    $('view'),
    legend('View'),
    angle('view', 'theta', {
      label: 'viewer θₒ',
      unit: '°',
      title: 'Inclination of the viewer to the normal plane',
      range: [-89, 89],
    }),
    near && angle('view', 'h', { label: 'offset h', title: 'Offset of the hit across the fibre', range: [-1, 1] }),
    angle('cut', 'theta', {
      label: 'cut at θᵢ',
      unit: '°',
      title: 'Inclination of the plot around the fibre',
      range: [-90, 90],
    }),
    angle('cut', 'phi', {
      label: 'cut at φᵢ',
      unit: '°',
      title: 'Azimuth of the plot along the fibre',
      range: [-180, 180],
    }),
    make(
      'div',
      { class: 'checks' },
      ...lobes.map((name, lobe) =>
        check(name, Boolean((state.lobes >> lobe) & 1), on => {
          state.lobes = on ? state.lobes | (1 << lobe) : state.lobes & ~(1 << lobe);
        }),
      ),
    ),
  );
  fill(
    $('show'),
    buttons(
      'Maps show',
      [
        ['value', 'S cos θ'],
        ['color', 'Colour'],
        ['pdf', 'Sampling density'],
      ],
      state.show,
      value => {
        state.show = value;
      },
    ),
    buttons(
      'Scale',
      [
        ['log', 'Log'],
        ['linear', 'Linear'],
      ],
      state.scale,
      value => {
        state.scale = value;
      },
    ),
    make(
      'span',
      { class: 'checks' },
      check('samples', state.samples, on => {
        state.samples = on;
      }),
    ),
  );
  const slot = isLinked() ? 0 : state.tab,
    material = edited(),
    model = kernel.model(material.model);
  const card = $('material');
  card.className = `card ${isLinked() ? '' : slot ? 'slot-b' : 'slot-a'}`;
  const presets = Object.keys(model.presets);
  const current = presets.find(name => !material.artist && isSame(model.presets[name], material.values));
  fill(
    card,
    legend('Materials'),
    ...[0, 1].map(which => {
      const own = state.materials[which],
        of = kernel.model(own.model);
      const row = make(
        'div',
        { class: which ? 'slot-b' : 'slot-a' },
        choice(
          make('span', { class: 'chip' }, `${'AB'[which]}`),
          kernel.models.map(({ name }) => ({ value: name })),
          own.model,
          name => {
            const values = isLinked() ? structuredClone(state.materials[0]) : null;
            state.materials[which] = newMaterial(kernel.model(name));
            if (values && !which)
              state.materials[1] = { ...state.materials[1], values: values.values, artist: values.artist };
            else if (values && isSame(kernel.model(name).fields, kernel.model(values.model).fields))
              Object.assign(state.materials[which], { values: values.values, artist: values.artist });
            state.lobes = 15;
            build();
            changed();
            commit();
          },
        ),
      );
      if (of.entries.length > 1)
        row.append(
          choice(
            `${of.choice} ${'AB'[which]}`,
            of.entries.map(({ word }) => ({ value: word })),
            own.word,
            word => {
              own.word = word;
              changed();
              commit();
            },
          ),
        );
      return row;
    }),
    haveSameFields()
      ? make(
          'div',
          { class: 'checks' },
          check('same parameters', state.linked, on => {
            if (!on)
              Object.assign(
                state.materials[1],
                structuredClone({ values: state.materials[0].values, artist: state.materials[0].artist }),
              );
            state.linked = on;
            queueMicrotask(build);
          }),
        )
      : null,
    isLinked()
      ? null
      : buttons(
          'Edit',
          [
            [0, `Edit A: ${models[0].name}`],
            [1, `Edit B: ${models[1].name}`],
          ],
          state.tab,
          tab => {
            state.tab = tab;
          },
        ),
    choice(
      'preset',
      [...(current ? [] : [{ value: '', text: 'edited' }]), ...presets.map(value => ({ value }))],
      current ?? '',
      name => {
        if (!name) return;
        material.values = structuredClone(model.presets[name]);
        if (material.artist) {
          kernel.setMaterial(slot, { ...material, artist: null });
          material.artist = kernel.toArtist(slot);
        }
        build();
        changed();
        commit();
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
          wanted => {
            if (wanted && !material.artist) {
              kernel.setMaterial(slot, material);
              material.artist = kernel.toArtist(slot);
            }
            if (!wanted && material.artist) {
              material.values = fieldsOf(material, slot);
              material.artist = null;
            }
          },
        )
      : null,
    ...materialRows(material),
  );
}
