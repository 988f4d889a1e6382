/// The example's page: hair that hairis-render has grown, under a directional light and a sky, with a panel of the model's fields.
import * as THREE from 'three/webgpu';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { buttons, check, fill, materialPanel, newMaterial, readLight, refuse, slider } from '#page';
import { Crossings, Hairis, Strands, lines, ribbons, sphereOf } from './library.js';
import { sky } from './sky.js';

const $ = id => document.getElementById(id);
/// A head has some 100,000 hairs. The file has fewer, which are as much thicker.
const WIDER = 4;
const state = { lines: false, azimuth: 40, elevation: 35, sun: 6, sky: 0.8, shadows: true };

/// The page's scene, for the console and for tests.
const page = (globalThis.hairis = {
  THREE,
  Crossings,
  Hairis,
  Strands,
  lines,
  readLight,
  ribbons,
  state,
  sky,
  frames: 0,
  pending: 0,
  isStale: true,
  isBusy: false,
});

async function start() {
  if (!navigator.gpu) throw new Error('This browser has no WebGPU');
  const [library, file] = await Promise.all([Hairis.load(), fetch('groom.hair').then(answer => answer.arrayBuffer())]);
  // `?every=20&model=gaussian`: as much hair as a driver in software draws, and the model at first. A strand stands for several.
  const query = new URLSearchParams(location.search),
    step = Number(query.get('every')) || 1,
    strands = Strands.read(file).every(step, WIDER * Math.sqrt(step)),
    crossings = new Crossings(strands),
    { center, radius } = sphereOf(strands);
  const renderer = new THREE.WebGPURenderer({ antialias: true });
  renderer.toneMapping = THREE.ACESFilmicToneMapping;
  await renderer.init();
  $('view').append(renderer.domElement);
  Object.assign(renderer.domElement, { ariaLabel: 'Hair; drag to turn it', role: 'img' });
  const scene = new THREE.Scene(),
    camera = new THREE.PerspectiveCamera(30, 1, radius / 50, radius * 20),
    light = new THREE.DirectionalLight();
  camera.position.copy(center).add(new THREE.Vector3(0.6, 0.15, 1).setLength(3.6 * radius));
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.target.copy(center);
  controls.enableDamping = true;
  controls.update();
  light.target.position.copy(center);
  scene.add(light, light.target);
  let hair = new THREE.Mesh(ribbons(strands));
  const geometries = { ribbons: hair.geometry };
  Object.assign(page, { library, strands, renderer, scene, camera, controls, light, crossings, material: null });

  /// Another model, or strands drawn otherwise, take another material; other values do not.
  async function shown(given, isOther) {
    page.pending++;
    try {
      page.isStale = true;
      if (!isOther) {
        page.material?.set(given);
        return '';
      }
      const options = {
        light,
        environment: sky(state.sky),
        lines: state.lines,
        crossings: state.shadows ? crossings : null,
      };
      const material = await library.material(given.model, given.values, options);
      scene.remove(hair);
      page.material?.dispose();
      const kind = state.lines ? 'lines' : 'ribbons';
      geometries[kind] ??= lines(strands);
      hair = new THREE[state.lines ? 'LineSegments' : 'Mesh'](geometries[kind], material);
      scene.add(hair);
      page.material = material;
      page.isStale = true;
      return '';
    } catch (error) {
      refuse(error.message);
      return error.message;
    } finally {
      page.pending--;
    }
  }
  let given = null;
  const keep = (material, isOther) => {
    given = material;
    return shown(material, isOther);
  };
  const aim = () => {
    const [a, e] = [(state.azimuth * Math.PI) / 180, (state.elevation * Math.PI) / 180];
    light.position
      .copy(center)
      .add(
        new THREE.Vector3(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)).multiplyScalar(4 * radius),
      );
    light.intensity = state.sun;
    if (page.material) page.material.environment = sky(state.sky);
    page.isStale = true;
  };
  const number = (label, name, range, unit) =>
    slider({ label, unit, range, get: () => state[name], set: value => ((state[name] = value), aim()) });
  const kinds = () => {
    fill(
      $('light'),
      number('azimuth', 'azimuth', [-180, 180], '°'),
      number('elevation', 'elevation', [-90, 90], '°'),
      number('light', 'sun', [0, 10]),
      number('sky', 'sky', [0, 2]),
      check('other strands', state.shadows, value => ((state.shadows = value), shown(given, true))),
      buttons(
        'Strands',
        [
          [false, 'Ribbons'],
          [true, 'Lines'],
        ],
        state.lines,
        value => ((state.lines = value), shown(given, true), kinds()),
      ),
    );
  };
  aim();
  kinds();
  await materialPanel(library.kernel, newMaterial(library.description(query.get('model') ?? 'chiang')), keep);

  const resize = () => {
    const { clientWidth: width, clientHeight: height } = $('view');
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    page.isStale = true;
  };
  new ResizeObserver(resize).observe($('view'));
  resize();
  renderer.setAnimationLoop(async () => {
    page.isStale ||= controls.update();
    if (page.isBusy || !page.isStale || !page.material) return;
    [page.isBusy, page.isStale] = [true, false];
    const begin = performance.now();
    renderer.render(scene, camera);
    await renderer.backend.device.queue.onSubmittedWorkDone();
    page.frames++;
    page.isBusy = false;
    $('note').textContent =
      `${strands.ends.length} strands, ${strands.count} segments, ${(performance.now() - begin).toFixed(0)} ms for the last frame. Strands are counted in cells of ${(crossings.side / crossings.size).toFixed(1)} cm; what they pass on to each other is dual scattering.`;
  });
}

start().catch(error => refuse(`The example did not start: ${error.message}.`));
