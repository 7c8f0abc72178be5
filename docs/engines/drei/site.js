// What the page is served, and what is done with the pictures and times that it sends.

import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { drei, lapidary, names, straight, views } from './techniques.js';
import { writeExr } from './exr.js';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

/** Saves linear texels that the page sends. */
async function savePicture(out, query, bytes) {
  const { view, name, width, height } = Object.fromEntries(query);
  const known = [straight.name, ...names].includes(name.replace(/\.turned$/, ''));
  if (!known || !views.some((each) => each.name === view)) throw new Error('an unknown picture');
  const texels = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  await writeExr(join(out, 'pictures', view, `${name}.exr`), { width: Number(width), height: Number(height), texels });
}

/** The site of ../browser.js; `processor` tells the rasterizer's processor time. */
export function site(out, { size, rounds, pictures }, processor = () => NaN) {
  return {
    files: {
      '/': here('page'),
      '/frame.js': here('../frame.js'),
      '/modules': here('node_modules'),
      '/out': out,
    },
    answers: {
      '/list.json': () => ({ size, rounds, pictures, views, straight, drei, lapidary }),
      '/processor': processor,
    },
    posts: {
      '/picture': (bytes, query) => savePicture(out, query, bytes),
      '/times': (bytes) => writeFileSync(join(out, 'times.json'), bytes),
    },
  };
}
