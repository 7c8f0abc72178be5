// node decode.mjs FOLDER: beside each .hdr and .exr file of a folder, writes NAME.raw, its width and height as u32
// and its texels, or NAME.txt, why it is not read.

import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { decodeEnvironment } from './scripts.mjs';

const folder = process.argv[2];
for (const name of readdirSync(folder).filter((name) => /\.(hdr|exr)$/.test(name))) {
  const path = join(folder, name);
  try {
    const { width, height, texels } = await decodeEnvironment(readFileSync(path), name);
    const size = new Uint8Array(Uint32Array.of(width, height).buffer);
    writeFileSync(`${path}.raw`, Buffer.concat([size, new Uint8Array(texels.buffer)]));
  } catch (error) {
    writeFileSync(`${path}.txt`, error.message);
  }
}
