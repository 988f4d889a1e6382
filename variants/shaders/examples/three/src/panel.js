// The page's own controls of a material, without its state, links and second material. Behind kernel.js, light.js, inputs.js and fields.js
// of harness/page, with which build.sh makes the module #page.

let hooks = {};
const changed = () => hooks.changed(),
  commit = () => {},
  build = () => hooks.build();

/// Fills `#material` with the controls of one material, and calls `shown` with a material of another model, or of other values.
///
/// `shown(material, isOther)` returns a refusal as text, or nothing; `isOther` is true for another model. Controls beside those of the
/// material are `rows`, made anew with them.
function materialPanel(loaded, material, shown, rows = () => []) {
  kernel = loaded;
  const given = ({ model, word, artist, values }) => {
    if (!artist) return { model, word, values };
    kernel.fromArtist(artist);
    return { model, word, values: kernel.readValues(kernel.model(model)) };
  };
  hooks = {
    changed() {
      const refusal = kernel.setMaterial(0, material);
      if (refusal) return refusal;
      refuse('');
      return shown(given(material), false);
    },
    build() {
      const model = kernel.model(material.model);
      fill(
        $('material'),
        choice(
          'model',
          kernel.models.map(({ name }) => ({ value: name })),
          material.model,
          name => {
            material = newMaterial(kernel.model(name));
            build();
            shown(given(material), true);
          },
        ),
        ...startRows(
          model,
          material,
          name => {
            Object.assign(material, { values: structuredClone(model.presets[name]), artist: null });
            build();
            changed();
          },
          wanted => {
            kernel.setMaterial(0, material);
            if (wanted) material.artist = kernel.toArtist(0);
            else Object.assign(material, { values: kernel.readValues(model), artist: null });
          },
        ),
        ...materialRows(material),
        ...rows(),
      );
    },
  };
  build();
  return shown(given(material), true);
}

export {
  Kernel,
  buttons,
  check,
  choice,
  direction,
  fill,
  make,
  materialPanel,
  newMaterial,
  readLight,
  refuse,
  skyLight,
  slider,
  toSrgb,
};
