// Controls: of the view, of what is shown and of both materials.

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
    ...startRows(
      model,
      material,
      name => {
        material.values = structuredClone(model.presets[name]);
        if (material.artist) {
          kernel.setMaterial(slot, { ...material, artist: null });
          material.artist = kernel.toArtist(slot);
        }
        build();
        changed();
        commit();
      },
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
    ),
    ...materialRows(material),
  );
}
