// Compares the pictures with the references, and writes results.json and a table.
// Usage: node score.js OUT SIZE ROUNDS COOK

import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { drei, names, views } from './techniques.js';
import { readExr } from './exr.js';
import { straightError } from './straight.js';

/** A change of luminance from a frame to the next that is seen as a jump. */
const JUMP = 0.25;

/** Pixels along each side of a block, for errors without aliasing. */
const BLOCK = 4;

const luminance = ([red, green, blue]) => 0.2126 * red + 0.7152 * green + 0.0722 * blue;
const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
const color = ({ texels }, pixel) => texels.subarray(4 * pixel, 4 * pixel + 3);
const covered = ({ texels }, pixel) => texels[4 * pixel + 3] > 0.5;

/** Pixels that the stone covers in a picture. */
function stone(picture) {
  const pixels = Array.from({ length: picture.width * picture.height }, (_, pixel) => pixel);
  return pixels.filter((pixel) => covered(picture, pixel));
}

function squared(a, b) {
  return mean([0, 1, 2].map((channel) => (a[channel] - b[channel]) ** 2));
}

/** Root of the mean squared difference of blocks' means, of blocks inside the stone. */
function blockRmse(picture, reference, mask) {
  const { width } = picture;
  const blocks = new Map();
  for (const pixel of mask) {
    const key = Math.floor(pixel / width / BLOCK) * width + Math.floor((pixel % width) / BLOCK);
    if (!blocks.has(key)) blocks.set(key, []);
    blocks.get(key).push(pixel);
  }
  const whole = [...blocks.values()].filter((pixels) => pixels.length === BLOCK ** 2);
  const blurred = (of, pixels) => [0, 1, 2].map((channel) => mean(pixels.map((pixel) => color(of, pixel)[channel])));
  return Math.sqrt(mean(whole.map((pixels) => squared(blurred(picture, pixels), blurred(reference, pixels)))));
}

function saturation(picture, mask) {
  return mean(mask.map((pixel) => {
    const [red, green, blue] = color(picture, pixel);
    const most = Math.max(red, green, blue);
    return most > 0 ? 1 - Math.min(red, green, blue) / most : 0;
  }));
}

/** Mean change of luminance and share of jumps when the camera turns, where the stone stays. */
function steadiness(picture, turned, mask) {
  const both = mask.filter((pixel) => covered(turned, pixel));
  const changes = both.map((pixel) => Math.abs(luminance(color(picture, pixel)) - luminance(color(turned, pixel))));
  return { change: mean(changes), jumps: mean(changes.map((change) => (change > JUMP ? 1 : 0))) };
}

/** FLIP by `cook compare`; null, with a message, if that fails. */
function flip(program, reference, picture) {
  try {
    const words = ['compare', reference, picture];
    const text = execFileSync(program, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
    return Number(/FLIP\s+([\d.]+)/.exec(text)[1]);
  } catch (error) {
    console.error(`no FLIP of ${picture}: ${error.message}`);
    return null;
  }
}

function scored(folder, name, { reference, mask }, program) {
  const file = join(folder, `${name}.exr`);
  const picture = readExr(file);
  const light = (of) => mean(mask.map((pixel) => luminance(color(of, pixel))));
  return {
    flip: flip(program, join(folder, 'reference.exr'), file),
    rmse: Math.sqrt(mean(mask.map((pixel) => squared(color(picture, pixel), color(reference, pixel))))),
    rmse_of_blocks: blockRmse(picture, reference, mask),
    light: light(picture) / light(reference),
    saturation: saturation(picture, mask),
    ...steadiness(picture, readExr(join(folder, `${name}.turned.exr`)), mask),
    uncovered: mask.filter((pixel) => !covered(picture, pixel)).length,
  };
}

const COLUMNS = [
  ['technique', (row) => row.name],
  ['ms', (row) => row.wall.ms.toFixed(0)],
  ['median', (row) => row.wall.median.toFixed(0)],
  ['x', (row) => row.wall.ratio.toFixed(2)],
  ['processor ms', (row) => row.processor.ms.toFixed(0)],
  ['x processor', (row) => row.processor.ratio.toFixed(2)],
  ['FLIP', (row) => row.flip?.toFixed(3) ?? '-'],
  ['RMSE', (row) => row.rmse.toFixed(3)],
  ['RMSE 4x4', (row) => row.rmse_of_blocks.toFixed(3)],
  ['light', (row) => row.light.toFixed(3)],
  ['saturation', (row) => row.saturation.toFixed(3)],
  ['change', (row) => row.change.toFixed(3)],
  ['jumps', (row) => row.jumps.toFixed(4)],
];

/** A table in Markdown. */
function table(rows) {
  const line = (cells) => `| ${cells.join(' | ')} |`;
  const head = [line(COLUMNS.map(([title]) => title)), line(COLUMNS.map(() => '---'))];
  return [...head, ...rows.map((row) => line(COLUMNS.map(([, cell]) => cell(row))))].join('\n');
}

const [out, size, rounds, program] = process.argv.slice(2);
const { times, ...machine } = JSON.parse(readFileSync(join(out, 'times.json')));

/** Times of all rounds in rising order, by `wall` clock or of the `processor`. */
function timed(name, clock) {
  const same = drei.find((technique) => technique.name === name)?.timed_as ?? name;
  return times[same].all.map((round) => round[clock]).sort((a, b) => a - b);
}

const least = (name, clock) => timed(name, clock)[0];
const median = (name, clock) => timed(name, clock)[Math.floor(timed(name, clock).length / 2)];

/** Times of a technique: milliseconds, and relative to drei's with three bounces. */
function timesOf(name) {
  const clocks = ['wall', 'processor'].map((clock) => {
    const ms = least(name, clock);
    return [clock, { ms, median: median(name, clock), ratio: ms / least('drei-3', clock) }];
  });
  return Object.fromEntries(clocks);
}

const of = Object.fromEntries(names.map((name) => [name, {}]));
const references = {};
for (const { name: view } of views) {
  const folder = join(out, 'pictures', view);
  const reference = readExr(join(folder, 'reference.exr'));
  const mask = stone(readExr(join(folder, 'surface.exr')));
  const straight = straightError(out, view);
  references[view] = { pixels: mask.length, saturation: saturation(reference, mask), straight };
  for (const name of names) of[name][view] = scored(folder, name, { reference, mask }, program);
}

const rows = names.map((name) => {
  const each = Object.values(of[name]);
  const over = (key) => mean(each.map((score) => score[key]));
  const keys = ['rmse', 'rmse_of_blocks', 'light', 'saturation', 'change', 'jumps'];
  const scores = Object.fromEntries(keys.map((key) => [key, over(key)]));
  const flips = each.every((score) => score.flip !== null) ? over('flip') : null;
  return { name, ...timesOf(name), flip: flips, ...scores };
});

const display = timesOf('display');
const asked = { size: Number(size), rounds: Number(rounds) };
const results = { ...machine, ...asked, references, display, techniques: rows, views: of, times };
writeFileSync(join(out, 'results.json'), `${JSON.stringify(results, null, 1)}\n`);
const notes = [
  `Means over ${views.length} views; times in the first, ${size} x ${size} pixels:`,
  `the least and the median of ${rounds} rounds.`,
  `The display pass, which is in no time above: ${display.wall.ms.toFixed(1)} ms.`,
  ...Object.entries(references).map(([view, { pixels, saturation: colors, straight }]) => {
    const agrees = `without a stone drei differs from the map by ${straight.toExponential(1)} at most`;
    return `View ${view}: ${pixels} stone pixels; the reference's saturation is ${colors.toFixed(3)}; ${agrees}.`;
  }),
];
const text = `${table(rows)}\n\n${notes.join('\n')}\n`;
writeFileSync(join(out, 'table.md'), text);
console.log(text);
