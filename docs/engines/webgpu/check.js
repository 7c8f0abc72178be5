// Draws both pages in a headless Chromium, and compares each picture with `cook render` of the same
// view. Usage: node check.js OUT COOK; or node check.js OUT COOK serve, to look at the pages.

import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { join, resolve } from 'node:path';
import { headless, serve } from '../browser.js';
import { checkTables } from './formulas.js';

/**
 * The largest FLIP from `cook render`. Both run the same shaders, and round differently: rays that
 * graze an edge inside a stone go to another facet. README.md has what is measured, and what errors show.
 */
const MOST = { gem: 0.01, paths: 0.007 };

/** Views of each page; the first is the one that the page starts with. */
const GEMS = [
  { name: 'gem', polar: 27, azimuth: 11, bounces: 8 },
  { name: 'gem_turned', polar: 62, azimuth: -40, bounces: 4 },
];
const PATHS = [
  { name: 'optical_path', camera: {}, sun: null },
  { name: 'optical_path_turned', camera: { polar: 60, azimuth: 75 }, sun: null },
  { name: 'optical_path_sun', camera: {}, sun: { polar: 40, azimuth: 60 } },
];
/** How the frame of the second page is made; a rung of the ladder for each grid that formulas hold for. */
const SCENE = 'dragon';
const FRAME = ['--without', 'environment', '--exposure', '1.5'];
const RUNGS = ['godunov-64', 'godunov-32'];

const [folder, program, serving] = process.argv.slice(2);
const out = resolve(folder);
const cook = (...words) => execFileSync(program, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'] });
const refuse = (text) => {
  throw new Error(text);
};

/** Has `cook` write something, unless it is there. */
function make(name, ...words) {
  const path = join(out, name);
  if (!existsSync(path)) cook(...words, '--out', path);
  return path;
}

const cross = (a, b) => [a[1] * b[2] - b[1] * a[2], a[2] * b[0] - b[2] * a[0], a[0] * b[1] - b[0] * a[1]];

/** The direction `polar` degrees off the vertical, and `azimuth` degrees from +z towards +x. */
function direction(polar, azimuth) {
  const [p, a] = [polar, azimuth].map((degrees) => (degrees * Math.PI) / 180);
  return [Math.sin(p) * Math.sin(a), Math.cos(p), Math.sin(p) * Math.cos(a)];
}

/** A node that looks, or shines, along its -z, which is away from `back`. */
function pose(node, back, place = [0, 0, 0]) {
  const right = cross([0, 1, 0], back);
  const unit = right.map((part) => part / Math.hypot(...right));
  const { rotation, translation, matrix, ...rest } = node;
  return { ...rest, matrix: [...unit, 0, ...cross(back, unit), 0, ...back, 0, ...place, 1] };
}

/** Copies a scene's file, with another camera and sun. */
function moved(from, to, { polar, azimuth, eye, sun }) {
  const old = readFileSync(from);
  const size = old.readUInt32LE(12);
  const scene = JSON.parse(old.subarray(20, 20 + size));
  scene.nodes = scene.nodes.map((node) => {
    if ('camera' in node) return pose(node, direction(polar, azimuth), eye);
    return sun && node.extensions?.KHR_lights_punctual ? pose(node, direction(sun.polar, sun.azimuth)) : node;
  });
  let text = JSON.stringify(scene);
  text += ' '.repeat((4 - (Buffer.byteLength(text) % 4)) % 4);
  const head = Buffer.from(old.subarray(0, 20));
  head.writeUInt32LE(Buffer.byteLength(text), 12);
  const all = Buffer.concat([head, Buffer.from(text), old.subarray(20 + size)]);
  all.writeUInt32LE(all.length, 8);
  writeFileSync(to, all);
}

/** The bytes of a resource of a frame. */
function resource(frame, name) {
  const { resources } = JSON.parse(readFileSync(join(frame, 'frame.json')));
  return readFileSync(join(frame, resources.find((row) => row.name === name).contents));
}

function flip(reference, picture) {
  return Number(/FLIP\s+([\d.]+)/.exec(cook('compare', reference, picture))[1]);
}

/** Compares a picture of a page with `cook render` of a scene's file seen as the page saw it. */
function compared(name, scene, camera, most, words) {
  const file = join(out, `${name}.glb`);
  moved(scene, file, camera);
  const reference = join(out, `${name}_by_cook.png`);
  cook('render', file, ...words, '--out', reference);
  const error = flip(reference, join(out, `${name}.png`));
  console.log(`${name}: FLIP ${error.toFixed(4)} from cook render ${words.join(' ')}`);
  if (!(error <= most)) refuse(`${name}.png differs from cook render by a FLIP of ${error}, more than ${most}`);
}

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const [parts, cameras] = [{}, {}];
const site = {
  files: { '/webgpu': here('.'), '/frame.js': here('../frame.js'), '/out': out },
  answers: { '/views.json': () => ({ gems: GEMS, paths: PATHS }) },
  posts: {
    '/picture': (bytes, query) => writeFileSync(join(out, `${query.get('name')}.png`), bytes),
    '/camera': (bytes, query) => (cameras[query.get('name')] = JSON.parse(bytes)),
    '/part': (bytes, query) => (parts[query.get('name')] = bytes),
    '/tables': (bytes) => writeFileSync(join(out, 'tables.txt'), bytes),
  },
};

function prepare() {
  const frames = RUNGS.map((rung, place) => make(place === 0 ? 'frame' : `frame_${rung}`, 'frame', SCENE, '--rung', rung, ...FRAME));
  return { frames, gem: make('frame_gem', 'frame', 'brilliant', '--rung', 'walk-8+tracker') };
}

async function check() {
  const { frames, gem } = prepare();
  checkTables(readFileSync(here('README.md'), 'utf8'), frames);
  await headless('/webgpu/check.html', site, { seconds: 1200 });
  for (const [name, bytes] of Object.entries(parts)) {
    if (!bytes.equals(resource(gem, `brilliant/${name}`))) refuse(`gem.html makes another ${name} than cook frame brilliant`);
  }
  console.log(`${Object.keys(parts).join(', ')}: byte for byte those of cook frame brilliant`);
  const [stone, body] = ['brilliant', SCENE].map((scene) => make(`${scene}.glb`, 'scene', scene));
  for (const { name, bounces } of GEMS) {
    compared(name, stone, cameras[name], MOST.gem, ['--rung', `walk-${bounces}+tracker`]);
  }
  const again = GEMS.at(-1).name;
  const lost = flip(join(out, `${again}.png`), join(out, `${again}_again.png`));
  if (lost !== 0) refuse(`after a lost device gem.html draws another picture, by a FLIP of ${lost}`);
  for (const { name } of PATHS) compared(name, body, cameras[name], MOST.paths, ['--rung', RUNGS[0], ...FRAME]);
}

try {
  if (serving) {
    prepare();
    const address = await serve({ ...site, port: 8080 });
    console.log(['gem.html', 'optical_path.html'].map((page) => `${address}/webgpu/${page}`).join('\n'));
  } else {
    await check();
  }
} catch (error) {
  console.error(`run: ${error.message.replace(/\s+/g, ' ')}`);
  process.exitCode = 1;
}
