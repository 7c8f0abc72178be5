// Starts the page: in a headless Chromium that measures on its software rasterizer, or for a browser
// of your own, to look at.
// Usage: node start.js OUT SIZE ROUNDS [pictures], or node start.js OUT SIZE serve to only look.

import { resolve } from 'node:path';
import { headless, serve } from '../browser.js';
import { processorTime } from './processor.js';
import { site } from './site.js';

const [folder, size, rounds, pictures] = process.argv.slice(2);
const out = resolve(folder);
try {
  if (rounds === 'serve') {
    console.log(`${await serve({ ...site(out, { size: Number(size), rounds: 0 }), port: 8080 })}/`);
  } else {
    let profile = null;
    const asked = { size: Number(size), rounds: Number(rounds), pictures: pictures === 'pictures' };
    const started = (folder) => (profile = folder);
    await headless('/?measure', site(out, asked, () => processorTime(profile)), { seconds: 24 * 3600, started });
  }
} catch (error) {
  console.error(error.message);
  process.exitCode = rounds === 'serve' ? 2 : 1;
}
