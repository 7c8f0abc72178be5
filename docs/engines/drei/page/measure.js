// The measurement that `./run` starts: times in the first view, and pictures of all views, sent to
// the server that serves this page.

import { camera, turned, turnFrame } from './camera.js';
import { drawsStone, displays, timeAll } from './timing.js';
import { Drei } from './drei.js';
import { Frame } from './frame.js';
import { openDevice } from './device.js';

/** How far the camera turns from a frame to the next, in degrees: docs/gem_ladder.md has the same. */
const TURN = 0.05;

async function send(path, body) {
  const response = await fetch(path, { method: 'POST', body });
  if (!response.ok) throw new Error(`${path}: ${response.status}`);
}

const tell = (line) => send('/log', line);

function sendPicture(view, name, { width, height, texels }) {
  return send(`/picture?${new URLSearchParams({ view, name, width, height })}`, texels);
}

const folder = (view, rung) => `/out/frames/${view}/${encodeURIComponent(rung)}`;

/** Times all techniques in a view; the display passes of ours are timed by themselves. */
async function times(list, view, device, drei) {
  const finish = () => device.queue.onSubmittedWorkDone();
  // A technique that runs the very program of another one, with another number, is not timed.
  const jobs = list.drei.filter((technique) => !technique.timed_as).map((technique) => {
    return { name: technique.name, draw: () => drei.draw(technique), finish: () => drei.finish() };
  });
  const frames = [];
  for (const rung of list.lapidary) {
    const frame = await Frame.load(device, folder(view.name, rung));
    frames.push(frame);
    jobs.push({ name: rung, draw: () => frame.draw(drawsStone), finish });
  }
  jobs.push({ name: 'display', draw: () => frames[0].draw(displays), finish });
  drei.look(camera(await Frame.load(device, `/out/frames/${view.name}/camera`)));
  const processor = async () => Number(await (await fetch('/processor')).text());
  const all = await timeAll(jobs, list.rounds, { told: tell, processor });
  frames.forEach((frame) => frame.destroy());
  return all;
}

/** Sends the pictures of a view, each also with the camera turned. */
async function pictures(list, view, device, drei) {
  const start = camera(await Frame.load(device, `/out/frames/${view.name}/camera`));
  for (const technique of [list.straight, ...list.drei]) {
    for (const [suffix, place] of [['', start], ['.turned', turned(start, TURN)]]) {
      drei.look(place);
      drei.draw(technique);
      await sendPicture(view.name, technique.name + suffix, drei.read());
    }
  }
  for (const rung of list.lapidary) {
    const frame = await Frame.load(device, folder(view.name, rung));
    for (const [suffix, degrees] of [['', 0], ['.turned', TURN]]) {
      turnFrame(frame, degrees);
      await sendPicture(view.name, rung + suffix, (await frame.run())['linear picture']);
    }
    frame.destroy();
  }
  await tell(`pictures of view ${view.name}`);
}

/** Measures all that the server lists. */
export async function measure(list) {
  const { device, driver } = await openDevice();
  device.addEventListener('uncapturederror', ({ error }) => send('/failed', error.message));
  const drei = await Drei.load('/out/scene.glb', '/out/environment.exr', list.size);
  const drivers = { WebGL: drei.driver, WebGPU: driver };
  await tell(`WebGL: ${drivers.WebGL}; WebGPU: ${drivers.WebGPU}`);
  const taken = await times(list, list.views[0], device, drei);
  await send('/times', JSON.stringify({ browser: navigator.userAgent, drivers, index: drei.index, times: taken }));
  for (const view of list.pictures ? list.views : []) await pictures(list, view, device, drei);
  await send('/done', '');
}
