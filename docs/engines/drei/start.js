// Starts the page: in a headless Chromium that measures on its software rasterizer, or for a browser
// of your own, to look at.
// Usage: node start.js OUT SIZE ROUNDS [pictures], or node start.js OUT SIZE serve to only look.

import { mkdtempSync, rmSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { spawn } from 'node:child_process';
import { tmpdir } from 'node:os';
import { serve } from './serve.js';

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
];

const [folder, size, rounds, pictures] = process.argv.slice(2);
const out = resolve(folder);
const looking = rounds === 'serve';

if (looking) {
  const tell = (error) => error && console.error(error.message);
  const server = await serve(out, { size: Number(size), rounds: 0, port: 8080 }, tell).catch((error) => {
    console.error(`port 8080: ${error.message}`);
    process.exit(2);
  });
  console.log(`http://localhost:${server.address().port}/`);
} else {
  const profile = mkdtempSync(join(tmpdir(), 'drei-'));
  const asked = { size: Number(size), rounds: Number(rounds), pictures: pictures === 'pictures', profile };
  let chromium = null;
  const ended = (error) => {
    if (error) console.error(error.message);
    process.exitCode = error ? 1 : 0;
    chromium?.kill();
  };
  const server = await serve(out, asked, ended);
  const address = `http://localhost:${server.address().port}/?measure`;
  const program = process.env.CHROMIUM ?? 'chromium';
  chromium = spawn(program, [...FLAGS, `--user-data-dir=${profile}`, address], { stdio: 'ignore' });
  const closed = (error) => {
    if (error instanceof Error) console.error(error.message);
    server.close();
    server.closeAllConnections();
    try {
      rmSync(profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 200 });
    } catch {
      // A process of Chromium still writes there; the system empties its folder of temporary files.
    }
    process.exitCode ??= 1;
  };
  chromium.on('error', closed);
  chromium.on('exit', closed);
}
