// Tests of links to states of the page.

/// Whatever a link says, the page shows it or says in a sentence which field is refused; nothing breaks, and Reset is the first view.
export async function links({ open, check }) {
  const page = await open(),
    first = await page.evaluate(() => JSON.stringify(hairis.state));
  /// Reads links without following them: for each the refusal and the state.
  const read = hashes =>
    page.evaluate(
      hashes => hashes.map(hairis.readLink).map(({ refusal = '', state }) => [refusal, JSON.stringify(state)]),
      hashes,
    );
  const hashOf = state => '#' + encodeURIComponent(typeof state === 'string' ? state : JSON.stringify(state));
  const base = JSON.parse(first),
    altered = (path, value) => {
      const state = structuredClone(base),
        names = path.split('.'),
        last = names.pop();
      names.reduce((of, name) => of[name], state)[last] = value;
      return state;
    };
  const refused = [
    ['nonsense', ''],
    ['{', ''],
    ['null', 'the state must be an object, got null'],
    ['[]', 'the state must be an object, got []'],
    ['"x"', 'the state must be an object'],
    ['1', 'the state must be an object'],
    [{ extra: 1 }, 'extra: unknown field, expected one of materials, linked, tab'],
    ['{"__proto__":{}}', '__proto__: unknown field'],
    [{ materials: [] }, 'materials must be a list of 2, got []'],
    [{ materials: [...base.materials, base.materials[0]] }, 'materials must be a list of 2'],
    [altered('tab', 7), 'tab must be one of 0, 1, got 7'],
    [altered('tab', 0.5), 'tab must be one of 0, 1, got 0.5'],
    [altered('lobes', 16), 'lobes must be a whole number in [0, 15], got 16'],
    [altered('show', 'colour'), 'show must be one of "value", "color", "pdf", got "colour"'],
    [altered('linked', 'yes'), 'linked must be one of true, false, got "yes"'],
    [altered('view.theta', 200), 'view.theta must be a number in [-90, 90], got 200'],
    [altered('view.phi', 0), 'view.phi: unknown field, expected one of theta, h'],
    [altered('light.exposure', 1e6), 'light.exposure must be a number in [-24, 24], got 1000000'],
    [altered('camera', [1e300, 0]), 'camera[0] must be a number in'],
    [altered('turn', [0, 0, 0]), 'turn must be a list of 2, got [0,0,0]'],
    [altered('turn', null), 'turn must be a list of 2, got null'],
    [first.replace('"phi":0', '"phi":1e999'), 'cut.phi must be a number in [-180, 180], got Infinity'],
    [
      altered('materials.0.model', '__proto__'),
      'materials[0].model must be one of gaussian, cauchy, kajiya-kay, chiang, d-eon, got "__proto__"',
    ],
    [altered('materials.1.word', 'best'), 'materials[1].word must be one of published, matched, got "best"'],
    [altered('materials.0.values', null), 'materials[0].values must be an object, got null'],
    [altered('materials.0.values', [1]), 'materials[0].values must be an object, got [1]'],
    [altered('materials.0.values', undefined), 'materials[0].values: missing'],
    [altered('materials.0.values.phi_g', undefined), 'materials[0].values.phi_g: missing'],
    [altered('materials.0.values.phi_g', [0.5]), 'materials[0].values.phi_g must be a number, got [0.5]'],
    [
      altered('materials.1.values.beta', [0, 0, 0]),
      'materials[1].values.beta[0] must be a width in [1e-4, pi] rad, got 0',
    ],
    [altered('materials.0.artist', {}), 'materials[0].artist.primary.color: missing'],
    [altered('materials.0.artist', 5), 'materials[0].artist must be an object, got 5'],
    [altered('materials.0.artist', false), 'materials[0].artist must be an object or null, got false'],
    [altered('materials.0.colour', 1), 'materials[0].colour: unknown field'],
    [altered('materials.0', 'x'.repeat(1e5)), 'materials[0] must be an object, got "xxx'],
  ];
  (await read(refused.map(([state]) => hashOf(state)))).forEach(([refusal, state], place) => {
    const [given, words] = refused[place],
      isRefused =
        refusal.startsWith(`The link was not read: ${words}`) && refusal.endsWith('The page shows its first view.');
    check(
      'a wrong link gets a sentence',
      isRefused && refusal.length < 300 && !refusal.includes('\n'),
      `${words}: ${refusal}`,
    );
    check('a wrong link is the first view', state === first, JSON.stringify(given).slice(0, 200));
  });
  const paths = Object.entries(base).flatMap(([name, value]) =>
    typeof value === 'object' ? Object.keys(value).map(inner => `${name}.${inner}`) : [name],
  );
  const tries = paths.flatMap(path =>
    [null, true, 7, -0.5, 1e300, '0', 'published', [], {}, [1, 2], { length: 2 }].map(value => [path, value]),
  );
  (await read(tries.map(([path, value]) => hashOf(altered(path, value))))).forEach(([refusal, state], place) => {
    const [path, value] = tries[place],
      name = path.replace(/\.(\d)/, '[$1]');
    const isShown = !refusal && state === JSON.stringify(altered(path, value)),
      isRefused = refusal.startsWith(`The link was not read: ${name}`) && state === first;
    check('a link is shown or refused by name', isShown || isRefused, `${path}, ${JSON.stringify(value)}: ${refusal}`);
  });
  const shown = [
    { materials: base.materials },
    { view: { theta: 10 } },
    altered('materials.1', { model: 'chiang', values: { beta_m: 0.3, beta_n: 0.3, melanin: [1, 0.5] } }),
    ...(
      await page.evaluate(() =>
        hairis.kernel.models.flatMap(({ name, entries, presets }) =>
          Object.values(presets).map(values => ({
            materials: entries.slice(-2).map(({ word }) => ({ model: name, word, values })),
          })),
        ),
      )
    ).filter(({ materials }) => materials.length === 2),
  ];
  (await read(shown.map(hashOf))).forEach(([refusal], place) =>
    check('a link is shown', refusal === '', `${JSON.stringify(shown[place])}: ${refusal}`),
  );
  // The surfaces and the tuft turn all the way around, and the link of that is read.
  for (const id of ['surface', 'tuft-0']) {
    await page.locator(`#${id}`).focus();
    for (let press = 0; press < 8; press++) await page.keyboard.press('Shift+ArrowRight');
    await page.keyboard.press('Shift+ArrowUp');
  }
  const turned = await page.evaluate(() => [location.hash, JSON.stringify(hairis.state)]);
  const [[refusal, state]] = await read([turned[0]]);
  check('a link of a turned view is read', refusal === '' && state === turned[1], refusal);
  // Links are followed from a page that is open and from none, and the controls are there.
  const follow = async (on, words) => {
    const notice = await on.locator('#notice').textContent();
    check('a link is followed', words ? notice.includes(words) : !notice, `${words}: ${notice}`);
    const rows = await on.locator('#view input[type=range], #material .row').count();
    check('the controls follow a link', rows > 10, `${words}: ${rows}`);
    await on.getByRole('button', { name: 'Reset' }).click();
    check('reset is the first view', (await on.evaluate(() => JSON.stringify(hairis.state))) === first, words);
  };
  for (const [state, words] of [refused[10], [altered('tab', 1), ''], refused[2]]) {
    await page.evaluate(async hash => {
      const followed = new Promise(done => addEventListener('hashchange', done, { once: true }));
      location.hash = hash;
      await followed;
    }, hashOf(state));
    await follow(page, words);
  }
  await page.context().close();
  const started = await open(hashOf(refused[10][0]));
  await follow(started, refused[10][1]);
  await started.context().close();
  console.log(`${refused.length + tries.length + shown.length} links are shown, or refused in a sentence`);
}
