// Has Lapidary write everything that both sides draw: the scene, its frames and the references.
// What is there already is kept. Usage: node prepare.js OUT SIZE COOK frames|references

import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { lapidary, scene, views } from './techniques.js';

const [out, size, program, all] = process.argv.slice(2);
const environment = join(out, 'environment.exr');

/** Runs `cook` unless its output is there. */
function cook(output, ...words) {
  if (existsSync(output)) return;
  console.log(words.join(' '));
  execFileSync(program, [...words, '--out', output], { stdio: ['ignore', 'ignore', 'inherit'] });
}

cook(join(out, 'scene.glb'), 'scene', scene);
for (const { name, from } of views) {
  const frames = join(out, 'frames', name);
  const pictures = join(out, 'pictures', name);
  mkdirSync(frames, { recursive: true });
  mkdirSync(pictures, { recursive: true });
  // A sample a pixel, in its middle, on both sides and in the reference.
  const view = ['--samples', '1', '--environment', environment, ...(from ? ['--from', from] : [])];
  // A frame of at most 512 pixels is one tile, whose matrix is that of the whole picture.
  const small = Math.min(size, 512);
  cook(join(frames, 'camera'), 'frame', scene, '--rung', 'surface', '--size', `${small}x${small}`, ...view);
  for (const name of lapidary) {
    // A rung, and options behind it.
    cook(join(frames, name), 'frame', scene, '--rung', ...name.split(' '), '--size', `${size}x${size}`, ...view);
  }
  if (all === 'references') {
    const reference = ['--rung', 'reference', '--size', `${size}x${size}`];
    cook(join(pictures, 'reference.exr'), 'render', scene, ...reference, ...view);
  }
}
