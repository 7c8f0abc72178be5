// Serves the page, its modules and the output folder, and takes pictures and results from the page.

import { createReadStream, statSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize, sep } from 'node:path';
import { fileURLToPath } from 'node:url';
import { drei, lapidary, names, straight, views } from './techniques.js';
import { processorTime } from './processor.js';
import { writeExr } from './exr.js';

const HERE = fileURLToPath(new URL('.', import.meta.url));
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.json': 'application/json', '.wgsl': 'text/plain' };

/** The file that a path of the page stands for; null outside the folders that are served. */
function file(out, path) {
  // What runs a frame is no page's own.
  if (path === '/frame.js') return join(HERE, '../frame.js');
  const [page, roots] = [join(HERE, 'page'), { modules: join(HERE, 'node_modules'), out }];
  const [, first, ...rest] = decodeURIComponent(path).split('/');
  const [root, under] = Object.hasOwn(roots, first) ? [roots[first], rest] : [page, [first || 'index.html']];
  const found = normalize(join(root, ...under));
  return found.startsWith(root + sep) && statSync(found, { throwIfNoEntry: false })?.isFile() ? found : null;
}

async function body(request) {
  const parts = [];
  for await (const part of request) parts.push(part);
  return Buffer.concat(parts);
}

/** Saves linear texels that the page sends. */
async function savePicture(out, query, bytes) {
  const { view, name, width, height } = Object.fromEntries(query);
  const known = [straight.name, ...names].includes(name.replace(/\.turned$/, ''));
  if (!known || !views.some((each) => each.name === view)) throw new Error('an unknown picture');
  const texels = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  await writeExr(join(out, 'pictures', view, `${name}.exr`), { width: Number(width), height: Number(height), texels });
}

/** Starts the server on this machine; `ended` is called at the page's end, with an error if any. */
export function serve(out, { size, rounds, pictures, profile, port = 0 }, ended) {
  const posts = {
    '/log': (bytes) => console.log(bytes.toString()),
    '/picture': (bytes, query) => savePicture(out, query, bytes),
    '/times': (bytes) => writeFileSync(join(out, 'times.json'), bytes),
    '/done': () => ended(),
    '/failed': (bytes) => ended(new Error(bytes.toString())),
  };
  const server = createServer(async (request, response) => {
    const { pathname, searchParams } = new URL(request.url, 'http://localhost');
    const answer = (code, type, text) => response.writeHead(code, { 'content-type': type }).end(text);
    try {
      if (request.method === 'POST') {
        if (!(pathname in posts)) return answer(404, 'text/plain', 'nothing takes this');
        await posts[pathname](await body(request), searchParams);
        return answer(200, 'text/plain', '');
      }
      if (pathname === '/list.json') {
        return answer(200, TYPES['.json'], JSON.stringify({ size, rounds, pictures, views, straight, drei, lapidary }));
      }
      if (pathname === '/processor') return answer(200, 'text/plain', String(processorTime(profile)));
      const found = file(out, pathname);
      if (!found) return answer(404, 'text/plain', 'not here');
      response.writeHead(200, { 'content-type': TYPES[extname(found)] ?? 'application/octet-stream' });
      createReadStream(found).pipe(response);
    } catch (error) {
      answer(500, 'text/plain', error.message);
      ended(error);
    }
  });
  return new Promise((resolve, reject) => {
    server.once('error', reject);
    server.listen(port, '127.0.0.1', () => resolve(server));
  });
}
