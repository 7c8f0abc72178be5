// The page to look at: a technique of each side by side, with times on request.

import { camera } from './camera.js';
import { drawsStone, timeAll } from './timing.js';
import { Drei } from './drei.js';
import { Frame } from './frame.js';
import { openDevice } from './device.js';

const element = (id) => document.querySelector(`#${id}`);

function choices(id, names, chosen) {
  element(id).replaceChildren(...names.map((name) => new Option(name, name, name === chosen, name === chosen)));
}

/** Radiance as sRGB. Both pictures are encoded here, alike; highlights above white are clipped. */
function encoded(radiance) {
  const x = Math.min(Math.max(radiance, 0), 1);
  return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
}

function show(id, { width, height, texels }) {
  const canvas = element(id);
  Object.assign(canvas, { width, height });
  const image = new ImageData(width, height);
  texels.forEach((value, place) => (image.data[place] = place % 4 === 3 ? 255 : encoded(value)));
  canvas.getContext('2d').putImageData(image, 0, 0);
}

/** Shows what is chosen, and draws again when the choice changes. */
export async function look(list) {
  const { device } = await openDevice();
  const drei = await Drei.load('/out/scene.glb', '/out/environment.exr', list.size);
  choices('view', list.views.map((view) => view.name));
  choices('drei', list.drei.map((technique) => technique.name), 'drei-3+3');
  choices('lapidary', list.lapidary, 'walk-8+tracker');
  let frame = null;
  const technique = () => list.drei.find(({ name }) => name === element('drei').value);

  async function draw() {
    const view = element('view').value;
    element('drei-time').value = '';
    element('lapidary-time').value = '';
    frame?.destroy();
    frame = await Frame.load(device, `/out/frames/${view}/${encodeURIComponent(element('lapidary').value)}`);
    const cameraFrame = await Frame.load(device, `/out/frames/${view}/camera`);
    drei.look(camera(cameraFrame));
    cameraFrame.destroy();
    drei.draw(technique());
    show('drei-picture', drei.read());
    show('lapidary-picture', (await frame.run())['linear picture']);
  }

  async function time() {
    const jobs = [
      { name: 'drei', draw: () => drei.draw(technique()), finish: () => drei.finish() },
      { name: 'lapidary', draw: () => frame.draw(drawsStone), finish: () => device.queue.onSubmittedWorkDone() },
    ];
    const times = await timeAll(jobs, 5, { most: 256 });
    for (const { name } of jobs) {
      const least = Math.min(...times[name].all.map(({ wall }) => wall));
      element(`${name}-time`).value = `${least.toFixed(2)} ms`;
    }
  }

  /** Runs one thing at a time, and shows why if it fails. */
  let running = Promise.resolve();
  const queue = (run) => () => {
    running = running.then(run).catch((error) => (element('note').textContent = error.message));
    return running;
  };
  for (const id of ['view', 'drei', 'lapidary']) element(id).addEventListener('change', queue(draw));
  element('time').addEventListener('click', queue(time));
  await queue(draw)();
}
