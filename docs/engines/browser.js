// A headless Chromium for the examples in this folder, and a server that it gets its pages from and
// sends its results to. It needs Node.js alone.
//
//   import { headless, serve } from '../browser.js';
//
//   const site = {
//     files: { '/': join(HERE, 'page'), '/out': out, '/frame.js': join(HERE, '../frame.js') },
//     answers: { '/list.json': () => ({ size: 512 }) },
//     posts: { '/picture': (bytes, query) => writeFileSync(join(out, `${query.get('name')}.png`), bytes) },
//   };
//   await headless('/index.html?check', site);           // draws on the software rasterizer
//   console.log(await serve({ ...site, port: 8080 }));   // or: to look at in a browser of one's own
//
// A page that `headless` opens ends it by a POST to /done, or to /failed with the reason as its body;
// a POST to /log prints a line.

import { createReadStream, mkdtempSync, rmSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize, sep } from 'node:path';
import { spawn } from 'node:child_process';
import { tmpdir } from 'node:os';

// WebGL (by ANGLE) and WebGPU (by Dawn) both run on SwiftShader, Chromium's own rasterizer.
const FLAGS = [
  '--headless=new',
  '--no-sandbox',
  '--no-first-run',
  '--disable-dev-shm-usage',
  '--disable-quic',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--disable-gpu-watchdog',
  '--use-gl=angle',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
  '--enable-unsafe-webgpu',
  '--use-webgpu-adapter=swiftshader',
  // A canvas of WebGPU's needs Chromium's own surfaces on Vulkan too: on GL its GPU process ends.
  '--use-vulkan=swiftshader',
  '--enable-features=Vulkan',
];

const TYPES = {
  '.css': 'text/css',
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.json': 'application/json',
  '.png': 'image/png',
  '.wgsl': 'text/plain',
};

/** The file that a path stands for, by the longest prefix of `files`; null outside of them. */
function found(files, path) {
  const decoded = decodeURIComponent(path);
  const under = (prefix) => decoded === prefix || decoded.startsWith(prefix.endsWith('/') ? prefix : `${prefix}/`);
  const prefix = Object.keys(files).filter(under).sort((a, b) => b.length - a.length)[0];
  if (prefix === undefined) return null;
  const root = normalize(files[prefix]);
  const file = normalize(join(root, decoded.slice(prefix.length)));
  if (file !== root && !file.startsWith(root.endsWith(sep) ? root : root + sep)) return null;
  const kind = statSync(file, { throwIfNoEntry: false });
  if (kind?.isFile()) return file;
  const index = join(file, 'index.html');
  return kind?.isDirectory() && statSync(index, { throwIfNoEntry: false })?.isFile() ? index : null;
}

async function body(request) {
  const parts = [];
  for await (const part of request) parts.push(part);
  return Buffer.concat(parts);
}

/** Serves a site on this machine; `failed` is called with an error of an answer or a post. */
function listen({ files = {}, answers = {}, posts = {}, port = 0 }, failed) {
  const server = createServer(async (request, response) => {
    const answer = (code, type, text) => response.writeHead(code, { 'content-type': type }).end(text);
    try {
      const { pathname, searchParams } = new URL(request.url, 'http://localhost');
      if (request.method === 'POST') {
        if (!Object.hasOwn(posts, pathname)) return answer(404, 'text/plain', 'nothing takes this');
        await posts[pathname](await body(request), searchParams);
        return answer(200, 'text/plain', '');
      }
      if (Object.hasOwn(answers, pathname)) {
        return answer(200, TYPES['.json'], JSON.stringify(await answers[pathname](searchParams)));
      }
      const file = found(files, pathname);
      if (!file) return answer(404, 'text/plain', 'not here');
      response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'application/octet-stream' });
      createReadStream(file).pipe(response);
    } catch (error) {
      answer(500, 'text/plain', error.message);
      failed(error);
    }
  });
  return new Promise((resolve, reject) => {
    server.once('error', (error) => reject(new Error(`port ${port}: ${error.message}`)));
    server.listen(port, '127.0.0.1', () => resolve(server));
  });
}

/**
 * Serves a site until the process ends, and returns its address. A site is its `files`: folders or
 * files by prefix of the path; `answers`: functions of the query that return what is sent as JSON;
 * `posts`: functions of the body's bytes and the query; and a `port`, by default any free one.
 */
export async function serve(site) {
  const posts = { '/log': (bytes) => console.log(bytes.toString()), ...site.posts };
  const server = await listen({ ...site, posts }, (error) => console.error(error.message));
  return `http://localhost:${server.address().port}`;
}

/**
 * Opens a page of a site in a headless Chromium, and returns when it is done. Throws what the page, an
 * answer or a post fails with, if Chromium does not start, and after a number of `seconds`. `started`
 * is called with the folder of Chromium's profile, by which its processes can be told from others.
 */
export async function headless(page, site, { seconds = 3600, started = () => {} } = {}) {
  const profile = mkdtempSync(join(tmpdir(), 'lapidary-'));
  const program = process.env.CHROMIUM ?? 'chromium';
  let done, fail;
  const ended = new Promise((resolve, reject) => ([done, fail] = [resolve, reject]));
  const posts = {
    '/log': (bytes) => console.log(bytes.toString()),
    '/done': () => done(),
    '/failed': (bytes) => fail(new Error(bytes.toString())),
    ...site.posts,
  };
  const server = await listen({ ...site, posts }, fail);
  started(profile);
  const address = `http://localhost:${server.address().port}${page}`;
  const chromium = spawn(program, [...FLAGS, `--user-data-dir=${profile}`, address], { stdio: 'ignore' });
  const gone = new Promise((resolve) => {
    chromium.once('error', (error) => resolve(fail(new Error(`${program}: ${error.message}`))));
    chromium.once('exit', () => resolve(fail(new Error(`${program} ended before the page was done`))));
  });
  // Chromium would outlive a process that is told to end.
  const interrupted = (signal) => fail(new Error(signal));
  const signals = ['SIGHUP', 'SIGINT', 'SIGTERM'];
  signals.forEach((signal) => process.once(signal, interrupted));
  const timer = setTimeout(() => fail(new Error(`${page} is not done after ${seconds} s`)), 1000 * seconds);
  try {
    await ended;
  } finally {
    clearTimeout(timer);
    signals.forEach((signal) => process.off(signal, interrupted));
    chromium.kill();
    await gone;
    server.close();
    server.closeAllConnections();
    try {
      rmSync(profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 200 });
    } catch {
      // A process of Chromium still writes there; the system empties its folder of temporary files.
    }
  }
}
