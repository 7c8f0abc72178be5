// Draws both pages in a headless Chromium and compares their pictures with Lapidary's own; or serves
// the pages, to look at. Usage: node check.js OUT COOK, or node check.js OUT serve

import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { headless, serve } from '../browser.js';

const HERE = fileURLToPath(new URL('.', import.meta.url));
// Rounding alone sends a few rays to other facets, which costs 0.005. An index wrong by 0.001 costs 0.008.
const LARGEST_FLIP = 0.007;

const [folder, cook] = process.argv.slice(2);
const out = resolve(folder);
const files = { '/': join(HERE, 'page'), '/three': join(HERE, 'node_modules/three'), '/out': out };

async function check(name) {
  const picture = join(out, `${name}.png`);
  let sent = false;
  const posts = {
    '/picture': (bytes) => {
      writeFileSync(picture, bytes);
      sent = true;
    },
  };
  await headless(`/${name}.html?check`, { files, posts }, { seconds: 300 });
  if (!sent) throw new Error('no picture came');
  const told = execFileSync(cook, ['compare', join(out, 'reference.png'), picture], { encoding: 'utf8' }).trim();
  console.log(`${name}: ${told}`);
  const flip = Number(told.match(/FLIP ([\d.]+)/)?.[1] ?? NaN);
  if (!(flip <= LARGEST_FLIP)) {
    throw new Error(`${picture} is not the picture of cook render: FLIP above ${LARGEST_FLIP}`);
  }
}

try {
  if (cook === 'serve') {
    const address = await serve({ files, port: 8080 });
    console.log(`${address}/webgpu.html and ${address}/webgl.html`);
  } else {
    for (const name of ['webgpu', 'webgl']) {
      await check(name).catch((error) => {
        throw new Error(`${name}: ${error.message}`);
      });
    }
  }
} catch (error) {
  console.error(`run: ${error.message.replace(/\s+/g, ' ')}`);
  process.exitCode = 1;
}
