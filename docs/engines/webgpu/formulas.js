// Checks the tables of README.md against frames: a formula is JavaScript, of n, the cells along an edge
// of the grid, and of what else the frame holds.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';

/** Rows of the table under a heading, as lists of cells. */
function table(text, heading) {
  const [, section = ''] = text.split(`\n## ${heading}\n`);
  const lines = section.split('\n## ')[0].split('\n').filter((line) => line.startsWith('| '));
  return lines.slice(1).map((line) => line.split('|').slice(1, -1).map((cell) => cell.trim()));
}

/** What stands between backquotes in a cell. */
const quoted = (cell) => [...cell.matchAll(/`([^`]*)`/g)].map(([, text]) => text);

/** The value of a formula, in words for a list of numbers. */
function value(formula, numbers) {
  const result = new Function('ceil', ...Object.keys(numbers), `return ${formula}`)(Math.ceil, ...Object.values(numbers));
  return [result].flat().join(' x ');
}

/** A resource's name without its body, channel and rung. */
const plain = (name) => name.replace(/^.*\//, '').replace(/ of (red|green|blue|[a-z]+-[\d-]+)$/, '');

/** What the formulas are of, as a frame has it. */
function numbers(folder, { resources }) {
  const named = (name) => resources.find((resource) => plain(resource.name) === name);
  return {
    n: readFileSync(join(folder, named('grid').contents)).readUInt32LE(16),
    vertices: named('positions').bytes / 12,
    triangles: named('indices').bytes / 12,
    lights: named('lights').bytes / 48,
    views: named('views of lights').bytes / 64,
    texels: named('reflective shadow maps').size[0],
    width: named('linear picture').size[0],
    height: named('linear picture').size[1],
    samples: named('samples').size[0] / named('linear picture').size[0],
  };
}

/** The sizes of a frame's resources, by name. */
function sizes({ resources }) {
  return resources.map(({ name, kind, bytes, size }) => [plain(name), kind === 'buffer' ? String(bytes) : size.join(' x ')]);
}

/** The sizes of a frame's draws and dispatches, and how often they are run, by entry point. */
function dispatches({ passes, pipelines }) {
  return passes.flatMap((pass) => {
    const of = ({ pipeline, workgroups, vertices }) => {
      const size = pass.kind === 'render' ? String(vertices) : (workgroups?.join(' x ') ?? 'indirect');
      return [pipelines[pipeline].entries[0], `${size}, ${pass.repeat ?? 1}`];
    };
    return (pass.dispatches ?? pass.draws ?? []).map(of);
  });
}

/** Throws unless rows and facts name the same things, and agree. */
function compare(folder, what, rows, facts) {
  const names = new Set(rows.map(([name]) => name));
  const missing = facts.find(([name]) => !names.has(name));
  if (missing) throw new Error(`README.md has no ${what} ${missing[0]}`);
  for (const [name, expected] of rows) {
    const found = facts.filter((fact) => fact[0] === name);
    if (found.length === 0) throw new Error(`${folder} has no ${what} ${name}, which README.md names`);
    const wrong = found.find((fact) => fact[1] !== expected);
    if (wrong) throw new Error(`README.md: ${what} ${name} is ${expected}, but ${wrong[1]} in ${folder}`);
  }
}

/** Throws if README.md has another size or dispatch than a frame, or if either names what the other lacks. */
export function checkTables(text, folders) {
  for (const folder of folders) {
    const frame = JSON.parse(readFileSync(join(folder, 'frame.json')));
    const all = numbers(folder, frame);
    const buffers = table(text, 'Buffers and textures').flatMap(([names, size]) =>
      quoted(names).map((name) => [name, value(quoted(size)[0], all)]));
    compare(folder, 'resource', buffers, sizes(frame));
    const passes = table(text, 'Passes').map(([, entry, size, repeat]) =>
      [quoted(entry)[0], `${value(quoted(size)[0], all)}, ${value(quoted(repeat)[0], all)}`]);
    compare(folder, 'entry point', passes, dispatches(frame));
  }
}
