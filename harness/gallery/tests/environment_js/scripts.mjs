// Loads the gallery's scripts as a page does: classic scripts, one after another.

import { readFileSync } from 'node:fs';
import vm from 'node:vm';

const ASSETS = new URL('../../src/assets/', import.meta.url);

for (const name of ['environment.js', 'piz.js']) {
  vm.runInThisContext(readFileSync(new URL(name, ASSETS), 'utf8'), { filename: name });
}

export const { decodeEnvironment } = globalThis.gallery;
