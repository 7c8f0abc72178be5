// Whether the shaders in gem.html are what `cook copy` prints; with `refresh`, writes them.
// Each stands between a mark that names its command and the next `<!-- end -->`.
// Usage: node shaders.js COOK [refresh]

import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';

const [program, refresh] = process.argv.slice(2);
const page = new URL('gem.html', import.meta.url);
const old = readFileSync(page, 'utf8');
const fresh = old.replaceAll(/(<!-- generated: cook (copy (\w+).*?) -->\n)[^]*?(<!-- end -->)/g, (_, begin, words, name, end) => {
  const text = execFileSync(program, words.split(' '), { encoding: 'utf8' });
  return `${begin}<script type="text/wgsl" id="${name}">\n${text}</script>\n${end}`;
});
if (refresh) {
  writeFileSync(page, fresh);
} else if (fresh !== old) {
  console.error('run: gem.html has other shaders than cook copy prints: run docs/engines/webgpu/run --refresh');
  process.exitCode = 1;
}
