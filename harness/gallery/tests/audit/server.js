// Serves a folder on this machine as a common static host does: with content types, and text compressed.

import { readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize, sep } from 'node:path';
import { gzipSync } from 'node:zlib';

const TYPES = {
  '.css': 'text/css; charset=utf-8',
  '.html': 'text/html; charset=utf-8',
  '.jpg': 'image/jpeg',
  '.js': 'text/javascript; charset=utf-8',
  '.json': 'application/json',
  '.png': 'image/png',
  '.svg': 'image/svg+xml',
  '.txt': 'text/plain; charset=utf-8',
  '.webp': 'image/webp',
  '.wgsl': 'text/plain; charset=utf-8',
  '.woff2': 'font/woff2',
};

const COMPRESSED = new Set(['.css', '.html', '.js', '.json', '.svg', '.txt', '.wgsl']);

/** The file of the folder that a path stands for; null outside of it. */
function found(folder, path) {
  const root = normalize(folder);
  const file = normalize(join(root, decodeURIComponent(path)));
  if (file !== root && !file.startsWith(root.endsWith(sep) ? root : root + sep)) return null;
  const kind = statSync(file, { throwIfNoEntry: false });
  if (kind?.isFile()) return file;
  return kind?.isDirectory() ? found(file, 'index.html') : null;
}

/** Serves the folder at any free port; `close` of what is returned ends it. */
export function serve(folder) {
  const server = createServer((request, response) => {
    const file = found(folder, new URL(request.url, 'http://localhost').pathname);
    if (!file) return response.writeHead(404, { 'content-type': 'text/plain' }).end('not here');
    const ending = extname(file);
    const headers = { 'content-type': TYPES[ending] ?? 'application/octet-stream', 'cache-control': 'max-age=600' };
    const bytes = readFileSync(file);
    if (!COMPRESSED.has(ending)) return response.writeHead(200, headers).end(bytes);
    response.writeHead(200, { ...headers, 'content-encoding': 'gzip' }).end(gzipSync(bytes));
  });
  return new Promise((resolve) => {
    server.listen(0, '127.0.0.1', () => {
      const close = () => {
        server.close();
        server.closeAllConnections();
      };
      resolve({ address: `http://localhost:${server.address().port}`, close });
    });
  });
}
