// What Lighthouse and axe say about a built gallery. See ./run --help.

import axe from 'axe-core';
import { existsSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import lighthouse from 'lighthouse';
import puppeteer from 'puppeteer-core';
import { serve } from './server.js';

/** Widths in CSS pixels: a phone's and a desktop's. */
const WIDTHS = [390, 1440];

/** A layout shift above this is shown with what moved: Lighthouse's own limit of what is good. */
const MOST_SHIFT = 0.1;

/** A page of each kind, and the folder of the kind. */
const KINDS = [
  ['index.html'],
  ['pictures.html'],
  ['techniques/gems.html', 'techniques/'],
  ['modules/refraction.html', 'modules/'],
  ['recipes/gem_walk.html', 'recipes/'],
  ['guides/choosing.html', 'guides/'],
  ['live/brilliant.html', 'live/'],
];

/** The page of a kind: one by its name, or the first of its folder if it has another name now. */
function pageOf(folder, [wanted, under]) {
  if (!under || existsSync(join(folder, wanted)) || !existsSync(join(folder, under))) return wanted;
  const name = readdirSync(join(folder, under)).filter((file) => file.endsWith('.html')).sort()[0];
  return name ? under + name : wanted;
}

function median(numbers) {
  return [...numbers].sort((a, b) => a - b)[Math.floor(numbers.length / 2)];
}

/** Lighthouse on its mobile profile: the performance of each round, and what lowers the rest. */
async function judged(browser, url, rounds) {
  const options = { port: Number(new URL(browser.wsEndpoint()).port), logLevel: 'error', output: 'json' };
  const [scores, faults] = [[], new Set()];
  let [accessibility, practices, lighter] = [100, 100, {}];
  for (let round = 0; round < rounds; round++) {
    // What is no performance is the same each time.
    const onlyCategories = round === 0 ? ['performance', 'accessibility', 'best-practices'] : ['performance'];
    const { lhr } = await lighthouse(url, { ...options, onlyCategories });
    if (lhr.runtimeError) throw new Error(`${url}: ${lhr.runtimeError.message}`);
    const score = (category) => Math.round(100 * lhr.categories[category].score);
    scores.push(score('performance'));
    if (round > 0) continue;
    [accessibility, practices] = [score('accessibility'), score('best-practices')];
    for (const category of ['accessibility', 'best-practices']) {
      for (const { id, weight } of lhr.categories[category].auditRefs) {
        const { score: reached, title } = lhr.audits[id];
        if (weight > 0 && reached !== null && reached < 1) faults.add(`${id}: ${title}`);
      }
    }
    const metric = (id) => lhr.audits[id].displayValue;
    if (lhr.audits['cumulative-layout-shift'].numericValue > MOST_SHIFT) {
      const moved = lhr.audits['layout-shifts']?.details?.items ?? [];
      for (const { score: by, node } of moved.slice(0, 3)) faults.add(`layout shift ${by.toFixed(3)}: ${node?.snippet ?? 'unknown'}`);
    }
    lighter = {
      lcp: metric('largest-contentful-paint'),
      tbt: metric('total-blocking-time'),
      cls: metric('cumulative-layout-shift'),
      bytes: lhr.audits['total-byte-weight'].numericValue,
    };
  }
  return { performance: median(scores), scores, accessibility, practices, faults: [...faults], ...lighter };
}

/** The violations that axe finds at each width, in light and dark. */
async function violations(browser, url) {
  const found = [];
  for (const scheme of ['light', 'dark']) {
    for (const width of WIDTHS) {
      const page = await browser.newPage();
      await page.setViewport({ width, height: 900 });
      await page.emulateMediaFeatures([
        { name: 'prefers-color-scheme', value: scheme },
        { name: 'prefers-reduced-motion', value: 'reduce' },
      ]);
      await page.goto(url, { waitUntil: 'load' });
      // Pages do some of their work when nothing else is waiting.
      await page.evaluate(() => new Promise((done) => requestIdleCallback(() => setTimeout(done, 100))));
      await page.evaluate(axe.source);
      const { violations } = await page.evaluate(() => globalThis.axe.run(document));
      for (const { id, help, nodes } of violations) {
        const where = nodes.slice(0, 3).map(({ target, failureSummary }) => `${target}: ${failureSummary.split('\n').at(-1).trim()}`);
        found.push(`${id} (${scheme}, ${width} px): ${help}; ${nodes.length} times: ${where.join(' | ')}`);
      }
      await page.close();
    }
  }
  return found;
}

async function audited(browser, address, page, { rounds, least }) {
  const url = `${address}/${page}`;
  const axeFound = await violations(browser, url);
  const seen = rounds > 0 ? await judged(browser, url, rounds) : null;
  const fine = axeFound.length === 0 && (!seen || (seen.performance >= least && seen.accessibility === 100));
  if (seen) {
    console.log(
      `${page}: performance ${seen.performance} (${seen.scores.join(' ')}), accessibility ${seen.accessibility}, ` +
        `best practices ${seen.practices}, LCP ${seen.lcp}, TBT ${seen.tbt}, CLS ${seen.cls}, ` +
        `${Math.round(seen.bytes / 1000)} kB; axe ${axeFound.length}`,
    );
  } else {
    console.log(`${page}: axe ${axeFound.length}`);
  }
  for (const line of [...(seen?.faults ?? []), ...axeFound]) console.log(`    ${line}`);
  return { page, fine, axe: axeFound, lighthouse: seen };
}

/** Audits the pages, and returns whether all hold. */
async function main({ folder, rounds, least, out, pages }) {
  const chosen = pages.length > 0 ? pages : KINDS.map((kind) => pageOf(folder, kind));
  const missing = chosen.find((page) => !existsSync(join(folder, page)));
  if (missing) throw new Error(`${folder}: no page ${missing}`);
  const server = await serve(folder);
  const browser = await puppeteer.launch({
    executablePath: process.env.CHROMIUM,
    args: ['--no-sandbox', '--disable-dev-shm-usage', '--disable-background-networking'],
  });
  try {
    const rows = [];
    for (const page of chosen) rows.push(await audited(browser, server.address, page, { rounds, least }));
    if (out) writeFileSync(out, `${JSON.stringify(rows, null, 2)}\n`);
    return rows.every(({ fine }) => fine);
  } finally {
    await browser.close();
    server.close();
  }
}

const [folder, rounds, least, out, ...pages] = process.argv.slice(2);
try {
  process.exitCode = (await main({ folder, rounds: Number(rounds), least: Number(least), out, pages })) ? 0 : 1;
} catch (error) {
  console.error(`audit: ${error.message}`);
  process.exitCode = 2;
}
