// Times techniques in interleaved rounds, so that whatever else the machine does meets them all.

/** Whether a pass draws the stone itself, into linear radiance and depth. */
export const drawsStone = (pass) => pass.kind === 'render' && ['scene', 'stones', 'gem_resolve'].includes(pass.name);

/** Whether a pass turns linear samples into the pictures of a frame. */
export const displays = (pass) => pass.kind === 'render' && pass.name === 'display';

/**
 * Milliseconds a picture takes that is drawn several times before the device is waited for: by the
 * clock, and of the rasterizer's processor time, which what else the machine does does not lengthen.
 */
async function timed({ draw, finish }, times, processor) {
  const before = await processor();
  const start = performance.now();
  for (let time = 0; time < times; time++) draw();
  await finish();
  const wall = (performance.now() - start) / times;
  return { wall, processor: ((await processor()) - before) / times };
}

/**
 * Times jobs of a name, a `draw` and a `finish`. Returns the times of all rounds by name. `processor`
 * tells the processor time up to now.
 */
export async function timeAll(jobs, rounds, { batch = 400, most = 32, told = () => {}, processor = () => NaN } = {}) {
  const plans = [];
  for (const job of jobs) {
    // The first picture compiles its shaders; the second tells how many fill the batch. After a
    // first one that is slow enough a second would tell no more.
    let once = (await timed(job, 1, processor)).wall;
    if (once < 8 * batch) once = (await timed(job, 1, processor)).wall;
    plans.push({ job, times: Math.max(1, Math.min(most, Math.ceil(batch / once))), all: [] });
    told(`${job.name}: about ${once.toFixed(0)} ms`);
  }
  for (let round = 0; round < rounds; round++) {
    for (const { job, times, all } of plans) all.push(await timed(job, times, processor));
    told(`round ${round + 1} of ${rounds}`);
  }
  return Object.fromEntries(plans.map(({ job, times, all }) => [job.name, { times, all }]));
}
