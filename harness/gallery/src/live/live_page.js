// The controls of a live page: they change the state of `Live`, which the address's fragment holds.

const section = document.querySelector('section.live');
const all = (selector) => [...section.querySelectorAll(selector)];
const one = (selector) => section.querySelector(selector);
const input = (name) => one(`[name="${name}"]`);
const [canvas, image, run, note, seam] = ['canvas', 'img', '.live-run', '.live-note', '.live-seam'].map(one);
const { scene } = section.dataset;

/** How often in a row a lost device is replaced. */
const MOST_LOSSES = 2;
/** A device that lasts this long in milliseconds begins a new row. */
const LASTING = 20000;

let live, settle;
const ready = new Promise((resolve, reject) => (settle = { resolve, reject }));
ready.catch(() => {});

/** Shows a sentence; one that says what went wrong stays until something is drawn. */
function tell(text, failed = false) {
  note.textContent = text;
  note.classList.toggle('failed', failed);
}

// The state and the address.

const round = (value) => Number(value.toFixed(4));
const clamped = (value, least, most) => Math.min(Math.max(value, least), most);

/** The eye at these angles in degrees, no nearer and no further than makes sense. */
function placed(polar, azimuth, distance) {
  const usual = live.start.distance;
  const turned = ((((azimuth + 180) % 360) + 360) % 360) - 180;
  return { polar: clamped(polar, 0.5, 179.5), azimuth: turned, distance: clamped(distance, 0.4 * usual, 3 * usual) };
}

/** The step whose value is nearest. */
function nearest(values, value) {
  const distances = values.map((of) => Math.abs(of - value));
  return distances.indexOf(Math.min(...distances));
}

/** The state that an address's fragment holds; what it lacks is as at the start. */
function parsed(fragment) {
  const asked = new URLSearchParams(fragment.includes('=') ? fragment : '');
  const { rungs, toggles, sliders } = live.manifest;
  const state = structuredClone(live.start);
  for (const name of ['rung', 'other']) if (Object.hasOwn(rungs, asked.get(name))) state[name] = asked.get(name);
  // An effect and its slider may have one name, then the address has it twice: once a word, once a number.
  const number = (name) => asked.getAll(name).map(Number.parseFloat).find(Number.isFinite);
  if (number('wipe') !== undefined) state.wipe = clamped(number('wipe'), 0, 100);
  for (const name of Object.keys(toggles)) {
    const word = asked.getAll(name).find((text) => text === 'on' || text === 'off');
    if (word) state.on[name] = word === 'on';
  }
  for (const [name, { values }] of Object.entries(sliders)) {
    if (number(name) !== undefined) state.steps[name] = nearest(values, number(name));
  }
  const view = (asked.get('view') ?? '').split(',').map(Number);
  return view.length === 3 && view.every(Number.isFinite) ? { ...state, ...placed(...view) } : state;
}

/** What a fragment asks for: of each wish its control, value and words. By the controls alone, for the scene's data may
 * not have come yet; fragments of headings, pictures and comparisons ask for nothing. */
function asked(fragment) {
  const wish = ([name, value]) => {
    const isNumber = Number.isFinite(Number.parseFloat(value));
    const of = (control, words) => ({ control, value, words });
    const labelled = (control) => of(control, `${control.labels[0].textContent.trim()}: ${value}`);
    if (name === 'view') return of(null, 'another view');
    if (name === 'wipe') return isNumber && of(input(name), `the wipe at ${value} %`);
    if (name === 'rung' || name === 'other') {
      const isKnown = [...input(name).options].some((option) => option.value === value);
      return isKnown && of(input(name), name === 'rung' ? value : `${value} beside it`);
    }
    // An effect and its slider may have one name.
    const toggle = all('[data-toggle]').find((box) => box.name === name);
    if (toggle && (value === 'on' || value === 'off')) return labelled(toggle);
    const slider = all('[data-slider] input').find((range) => range.name === name);
    return slider && isNumber && labelled(slider);
  };
  const pairs = fragment.includes('=') ? [...new URLSearchParams(fragment)] : [];
  return pairs.map(wish).filter(Boolean);
}

/** Says what the link asks for, as long as it is not drawn. */
function reflectLink() {
  const wishes = live ? [] : asked(location.hash.slice(1));
  one('.live-asked').hidden = wishes.length === 0;
  one('.live-asked').textContent = `This link asks for ${wishes.map(({ words }) => words).join('; ')}. Run it to see that.`;
  if (live) return;
  // The controls that need no data show it already.
  const valueOf = (control) => wishes.find((wish) => wish.control === control)?.value;
  for (const menu of ['rung', 'other'].map(input)) menu.value = valueOf(menu) ?? menu.options[0].value;
  for (const box of all('[data-toggle]')) box.checked = valueOf(box) ? valueOf(box) === 'on' : box.defaultChecked;
}

/** The fragment that holds a state: what is not as at the start. */
function fragment() {
  const { start, state, manifest } = live;
  const found = [];
  const keep = (name, value, usual, text) => value !== usual && found.push([name, text]);
  for (const name of ['rung', 'other', 'wipe']) keep(name, state[name], start[name], state[name]);
  for (const [name, on] of Object.entries(state.on)) keep(name, on, start.on[name], on ? 'on' : 'off');
  for (const [name, step] of Object.entries(state.steps)) {
    keep(name, step, start.steps[name], manifest.sliders[name].values[step]);
  }
  if (live.isTurned) found.push(['view', [state.polar, state.azimuth, state.distance].map(round).join()]);
  return new URLSearchParams(found).toString();
}

/** What is moved, and whether `./cook render` has an option for it. */
function moved() {
  const { manifest, start, state } = live;
  const sliders = Object.entries(manifest.sliders).filter(([name]) => state.steps[name] !== start.steps[name]);
  const label = (name) => one(`[data-slider="${name}"] label`).textContent.trim();
  const without = sliders.filter(([, { option }]) => !option).map(([name]) => label(name));
  const isNear = Math.abs(state.distance - start.distance) < 0.005 * start.distance;
  return { sliders, without: [...without, ...(isNear ? [] : ['the distance of the eye'])] };
}

/** A word as a shell takes it. */
const quoted = (word) => (/^[\w.-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

/** The command that draws it, as far as there are options for it. */
function command() {
  const { manifest, state } = live;
  const words = ['./cook render', scene, '--rung', state.rung, '--samples', manifest.samples];
  for (const name of manifest.rungs[state.rung].toggles) {
    words.push(manifest.toggles[name].options[state.on[name] ? 'on' : 'off']);
  }
  for (const [name, { option, values }] of moved().sliders) if (option) words.push(option, values[state.steps[name]]);
  if (live.isTurned) words.push('--from', `${round(state.polar)},${round(state.azimuth)}`);
  if (live.environment) words.push('--environment', quoted(live.environment.name ?? 'FILE'));
  return words.filter((word) => word !== '').join(' ');
}

/** The pipelines that draw the scene by the first rung, with their texts. */
function pipelines() {
  const [{ frame }] = live.sides;
  const { draws } = frame.rows.passes.find(({ name }) => name === 'scene');
  const seen = new Map(draws.map(({ pipeline }) => [frame.texts[pipeline], pipeline]));
  return [...seen.values()].map((place) => ({ place, text: frame.texts[place], ...frame.rows.pipelines[place] }));
}

/** A pipeline's effects that are on and off, and its other constants. */
function chosen({ overrides }) {
  const constants = Object.entries(overrides);
  const effects = (on) => constants.filter(([name, value]) => name.startsWith('EFFECT_') && (value !== 0) === on);
  const name = ([of]) => of.slice('EFFECT_'.length).toLowerCase();
  const others = constants.filter(([of]) => !of.startsWith('EFFECT_'));
  return { on: effects(true).map(name), off: effects(false).map(name), set: others.map((pair) => pair.join('=')) };
}

/** Shows the command that draws it, and what that leaves out. */
function reflectCommand() {
  const { without } = moved();
  one('.live-command code').textContent = command();
  one('.live-left').textContent = without.length > 0 ? `The command has no option for what was moved here, so it draws without: ${without.join(', ')}.` : '';
  one('.live-left').hidden = without.length === 0;
}

/** Shows the commands that write the shaders that are drawn with, and links to their recipes. */
function reflectShaders() {
  // A new device has none yet; those of the old one stand until then.
  if (live.sides.length === 0) return;
  const copied = pipelines().filter(({ copy }) => copy);
  one('.live-copying').hidden = copied.length === 0;
  one('.live-copying code').textContent = copied.map(({ copy }) => copy).join('\n');
  const [links, recipes] = [one('.live-recipes'), [...new Set(copied.map(({ recipe }) => recipe))]];
  // Otherwise a link would lose the focus with each picture.
  if (links.dataset.recipes === recipes.join()) return;
  links.dataset.recipes = recipes.join();
  links.replaceChildren(...recipes.flatMap((recipe) => {
    const link = document.createElement('a');
    [link.href, link.textContent] = [`${gallery.root}recipes/${recipe}.html`, recipe];
    return [link, ', or '];
  }));
}

/** Shows the state in the controls, the command and the address. */
function reflect() {
  const { manifest, state } = live;
  const rungs = [state.rung, state.other].map((name) => manifest.rungs[name]);
  for (const name of ['rung', 'other', 'wipe']) input(name).value = state[name];
  // The row keeps its place, so that no control slides under a pointer.
  const same = state.other === state.rung;
  input('wipe').disabled = !state.other || same;
  for (const option of input('other').options) option.disabled = option.value === state.rung;
  seam.hidden = canvas.hidden || !state.other || same;
  seam.style.left = `${state.wipe}%`;
  for (const [at, name] of [state.rung, state.other].entries()) {
    const side = all('.live-side')[at];
    [side.hidden, side.textContent] = [seam.hidden, name];
  }
  const wiped = same ? 'same rung twice' : `${state.wipe} %`;
  one('[data-wipe] output').textContent = state.other ? wiped : 'nothing beside';
  for (const box of all('[data-toggle]')) {
    box.disabled = !rungs.some((rung) => rung?.toggles.includes(box.name));
    // A rung without the effect has it off, whatever the state keeps for the others.
    box.checked = state.on[box.name] && !box.disabled;
  }
  for (const [name, { values, unit, start }] of Object.entries(manifest.sliders)) {
    const text = `${Number(values[state.steps[name]].toPrecision(3))} ${unit}`.trim();
    // Not by its name, which an effect may have too.
    const range = one(`[data-slider="${name}"] input`);
    range.value = state.steps[name];
    // An effect that is off has nothing that its slider could move.
    range.disabled = state.on[name] === false || !rungs.some((rung) => rung?.moves.some(({ slider }) => slider === name));
    range.setAttribute('aria-valuetext', text);
    one(`[data-slider="${name}"] output`).textContent = text;
    one(`[data-slider="${name}"] [data-reset]`).disabled = state.steps[name] === start;
  }
  reflectCommand();
  if (fragment() !== location.hash.slice(1)) history.replaceState(null, '', `#${fragment()}`);
}

// Drawing: never more than the device keeps up with.

let [drawing, wanted] = [null, false];
/** The measurement that runs: what stops it, and a promise that is kept when it has ended. */
let measuring = null;
const [MEASURING, STOPPED] = ['Measuring …', 'Something was changed, so the measurement stopped.'];

/** Draws, and once more if the state changed meanwhile. */
async function drawn() {
  do {
    wanted = false;
    await new Promise(requestAnimationFrame);
    await live.draw();
  } while (wanted);
}

/** Stops the measurement that runs; the promise is kept when it has ended. */
async function stopMeasuring() {
  const stopped = measuring;
  measuring = null;
  stopped?.stop.abort();
  await stopped?.done;
}

/** Changes the state, and draws; the promise is kept when it is shown. */
function set(changes = {}) {
  Object.assign(live.state, changes);
  reflect();
  one('.live-time').textContent = '';
  // What was said is of what was shown, but for why no time is there.
  if (measuring) tell(STOPPED);
  else if (!note.classList.contains('failed') && note.textContent !== STOPPED) tell('');
  wanted = true;
  // What is timed must stand until then.
  const ended = stopMeasuring();
  drawing ??= ended
    .then(drawn)
    .then(() => note.classList.contains('failed') && tell(''))
    .then(reflectShaders)
    .finally(() => (drawing = null));
  return drawing.catch(failed);
}

/** Says why it does not run; the picture stands there again. */
function failed(error) {
  const reason = error.message.split('\n')[0].replace(/[.\s]+$/, '');
  tell(`${reason[0]?.toUpperCase()}${reason.slice(1)}. The picture above is the one that the renderer draws.`, true);
  [canvas.hidden, image.hidden, run.hidden, seam.hidden, one('.live-device').hidden] = [true, false, false, true, true];
  one('.live-controls').disabled = true;
  settle.reject(error);
}

let [losses, since] = [0, 0];
// How often a device was lost in all: by it `begin` sees that its own was lost meanwhile.
let lostDevices = 0;

/** Replaces a lost device by another one, but not for ever. */
async function lost(message) {
  lostDevices += 1;
  stopMeasuring();
  losses = performance.now() - since > LASTING ? 1 : losses + 1;
  if (losses > MOST_LOSSES) return failed(new Error('The graphics device was lost again and again'));
  tell(`The graphics device was lost, so the scene starts on a new one. ${message}`, true);
  await drawing?.catch(() => {});
  return begin();
}

/** What the browser tells of the graphics device. */
function adapterName() {
  const { description, vendor, architecture } = live.adapter ?? {};
  return description || [vendor, architecture].filter(Boolean).join(' ') || 'your graphics device';
}

/** Draws on a new device. */
async function begin() {
  try {
    since = performance.now();
    const before = lostDevices;
    // What went wrong on the device before is no fault of the new one.
    live.error = null;
    await live.open(lost);
    await live.draw();
    // What is drawn on a lost device ends too, and the loss may be told a moment later.
    await Promise.race([live.device.lost, new Promise((resolve) => setTimeout(resolve, 0))]);
    if (lostDevices !== before) return;
    [canvas.hidden, image.hidden, run.hidden] = [false, true, true];
    one('.live-controls').disabled = false;
    one('.live-device').hidden = false;
    one('.live-device').textContent = `Running on ${adapterName()}.`;
    reflect();
    reflectShaders();
    tell('');
    settle.resolve();
  } catch (error) {
    failed(error);
  }
}

/** Loads the scene's data, and draws it as the address says. */
async function start() {
  tell('Loading the scene and compiling its shaders …');
  run.disabled = true;
  run.textContent = 'Starting …';
  try {
    if (!navigator.gpu) throw new Error('This browser has no WebGPU');
    live ??= new Live(await gallery.load(`live/${scene}`), canvas);
    Object.assign(live.state, parsed(location.hash.slice(1)));
    reflectLink();
    losses = 0;
    await begin();
    canvas.focus({ preventScroll: true });
  } catch (error) {
    failed(error);
  }
  run.disabled = false;
  run.textContent = 'Run it on your GPU';
}

// What one does.

/** Runs of a frame whose median is its time, and runs before them, in which the device speeds up. */
const [RUNS, WARM_UP] = [11, 5];
/** A device that took this long in milliseconds is awake. */
const AWAKE = 500;
/** Browsers round a device's clock to tenths of milliseconds; shorter frames are timed by many, this long together. */
const [SHORT, LONG_ENOUGH] = [2, 20];

/** Milliseconds that a frame takes with all its passes. A signal stops it after the run that is under way. */
async function timeOf(frame, signal) {
  const done = () => frame.device.queue.onSubmittedWorkDone();
  for (let at = 0, begin = performance.now(); at < WARM_UP && performance.now() - begin < AWAKE; at++) {
    signal.throwIfAborted();
    frame.draw();
    await done();
  }
  const alone = await frame.time(RUNS, signal);
  signal.throwIfAborted();
  if (alone >= SHORT) return alone;
  const means = [];
  for (const count = Math.ceil(LONG_ENOUGH / Math.max(alone, 0.05)); means.length < RUNS; ) {
    signal.throwIfAborted();
    const begin = performance.now();
    for (let at = 0; at < count; at++) frame.draw();
    await done();
    means.push((performance.now() - begin) / count);
  }
  return means.sort((a, b) => a - b)[means.length >> 1];
}

/** Times the frames of rungs that are shown, of the ladder's size and samples and as at the start. */
async function times(sides, signal) {
  const stopped = new Promise((_, reject) => signal.addEventListener('abort', () => reject(signal.reason)));
  const found = [];
  for (const { name, rung } of sides) {
    signal.throwIfAborted();
    const loading = live.load(rung.timed);
    try {
      // Shaders may compile for seconds, and nothing stops that.
      found.push({ rung: name, ms: await timeOf(await Promise.race([loading, stopped]), signal) });
    } finally {
      loading.then((frame) => frame.destroy(), () => {});
    }
  }
  return found;
}

/** What a text to paste must say of itself, as comments. */
function header(pipeline) {
  const [{ frame, name }] = live.sides;
  const { on, off, set } = chosen(pipeline);
  const groups = frame.rows.bind_groups.filter((group) => group.pipeline === pipeline.place);
  const bindings = new Map();
  for (const { group, entries } of groups) {
    for (const { binding, resource } of entries) bindings.set(`@group(${group}) @binding(${binding})`, frame.rows.resources[resource]);
  }
  const field = ({ name: of, type, offset }) => `${of}: ${type} at ${offset}`;
  const told = [...bindings].sort().map(([at, { name: of, layout }]) => {
    const held = layout ? `, ${layout.name} of ${layout.bytes} bytes: ${layout.fields.map(field).join(', ')}` : '';
    return `  ${at} is ${of}${held}`;
  });
  return [
    `${pipeline.recipe}, a recipe of Lapidary ${live.manifest.version}, as rung ${name} draws ${scene}`,
    'SPDX-License-Identifier: MIT-0 OR Apache-2.0',
    `Effects on: ${on.join(', ') || 'none'}; off, and cut out: ${off.join(', ') || 'none'}`,
    `Constants: ${set.join(', ') || 'none'}`,
    'Sliders and camera are no part of this text: their values are in buffers, here with the bytes where fields start:',
    ...told,
    `Every binding is explained on recipes/${pipeline.recipe}.html of this gallery; their contents for this scene are written by`,
    `  ./cook frame ${scene} --rung ${name} --out FOLDER`,
    ...(pipeline.copy ? [`The cookbook's own text of it: ${pipeline.copy}`] : []),
  ].map((line) => `// ${line}\n`).join('');
}

/** The shaders that draw the scene by the first rung, as they are compiled, each under its header. */
function shader() {
  return pipelines().map((pipeline) => `${header(pipeline)}\n${pipeline.text}`).join('\n');
}

/** Reads back the texture that the canvas shows. */
async function readback() {
  const { device, shown } = live;
  const { width, height } = shown;
  const usage = GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ;
  const buffer = device.createBuffer({ size: 4 * width * height, usage });
  const encoder = device.createCommandEncoder();
  encoder.copyTextureToBuffer({ texture: shown }, { buffer, bytesPerRow: 4 * width }, [width, height]);
  device.queue.submit([encoder.finish()]);
  await buffer.mapAsync(GPUMapMode.READ);
  const rgba = new Uint8Array(buffer.getMappedRange().slice(0));
  buffer.destroy();
  return { width, height, rgba };
}

/** Measures, says how long a frame takes, and puts it into the ladder's plot. */
async function timed(signal) {
  await drawing?.catch(() => {});
  const { manifest, sides } = live;
  // That it does not run, or starts on a new device, has been said.
  if (signal.aborted || canvas.hidden || sides.length === 0) return;
  tell(MEASURING);
  const measured = await times(sides, signal);
  const shown = [];
  for (const { name, frame } of sides) shown.push({ rung: name, ms: await timeOf(frame, signal) });
  signal.throwIfAborted();
  // The next picture would fail by it too.
  if (live.error) return failed(live.error);
  const { side, samples } = manifest.timed;
  const each = (of) => of.map(({ rung, ms }) => `${rung}: ${Number(ms.toPrecision(2))} ms on your GPU`).join(', ');
  const size = (width, height, samples) => `${width} × ${height} pixels, ${samples === 1 ? 'one sample' : `${samples * samples} samples`} each`;
  const ladder = `The ladder’s frame (${size(side, side, samples)}, controls as at the start): ${each(measured)}.`;
  const now = ` The picture on screen (${size(canvas.width, canvas.height, manifest.samples)}, controls as they are), all its passes: ${each(shown)}.`;
  one('.live-time').textContent = `${ladder}${now} Measured on ${adapterName()}.`;
  if (note.textContent === MEASURING) tell('');
  for (const { rung, ms } of measured.filter(({ rung }) => manifest.rungs[rung].error !== null)) {
    const ladder = document.querySelector(`#ladder-${manifest.ladder}`);
    if (ladder) gallery.plotPoint?.(ladder, ms, manifest.rungs[rung].error, `${rung} on your GPU`);
  }
}

/** Measures until it is stopped, and says what went wrong. */
async function measureUntil(signal) {
  try {
    await timed(signal);
  } catch (error) {
    // The loss of a device may be told a moment later than what it breaks.
    if (!signal.aborted) await new Promise((resolve) => setTimeout(resolve, 0));
    // Who stopped it has said why.
    if (!signal.aborted) tell(error.message, true);
  }
}

/** Measures, once at a time. */
function measure() {
  if (measuring) return measuring.done;
  const stop = new AbortController();
  const done = measureUntil(stop.signal).finally(() => measuring?.stop === stop && (measuring = null));
  measuring = { stop, done };
  return done;
}

/** Lights the scene by a picture: its width, height and texels. */
function light(environment) {
  const { width, height } = environment;
  const most = live.device.limits.maxTextureDimension2D;
  if (Math.max(width, height) > most) {
    throw new Error(`the picture has ${width} × ${height} pixels, and this graphics device takes ${most} a side`);
  }
  live.environment = environment;
  return set();
}

/** Lights the scene by a file. */
async function lightBy(file) {
  try {
    tell(`Reading ${file.name} …`);
    const picture = await gallery.decodeEnvironment(await file.arrayBuffer(), file.name);
    await light(Object.assign(picture, { name: file.name }));
    tell(`Lit by ${file.name}.`);
  } catch (error) {
    tell(error.message, true);
  }
}

/** Copies a text, and says so on the button that was pressed. */
async function copy(button, text, what) {
  const done = await gallery.copy(text);
  tell(done ? `${what} is in the clipboard.` : `${what} could not be copied: this browser gives no way to it here.`);
  button.textContent = done ? 'Copied' : 'Not copied';
  setTimeout(() => (button.textContent = button.dataset.label), 2000);
}

const actions = {
  time: measure,
  shader: (button) => copy(button, shader(), 'The shader'),
  link: (button) => copy(button, location.href, 'The link'),
  start: () => set(structuredClone(live.start)),
};
for (const button of all('[data-do]')) button.addEventListener('click', () => actions[button.dataset.do](button));

section.addEventListener('input', ({ target }) => {
  const { name, value, type, checked } = target;
  if (target.matches('[data-toggle]')) set({ on: { ...live.state.on, [name]: checked } });
  else if (target.closest('[data-slider]')) set({ steps: { ...live.state.steps, [name]: Number(value) } });
  else if (name === 'wipe') set({ wipe: Number(value) });
  else if (type === 'file' && target.files[0]) lightBy(target.files[0]);
  else if (name === 'rung' || name === 'other') set({ [name]: value });
});
for (const button of all('[data-reset]')) {
  const name = button.parentElement.dataset.slider;
  button.addEventListener('click', () => set({ steps: { ...live.state.steps, [name]: live.start.steps[name] } }));
}

/** Moves the eye by angles in degrees, and to a share of its distance. */
const move = (polar, azimuth, share = 1) => {
  const { state } = live;
  set(placed(state.polar + polar, state.azimuth + azimuth, state.distance * share));
};

/** How near the seam in pixels a drag moves it instead of the eye. */
const SEAM = 14;

/** The wipe under a pointer, in percent. */
function wipeAt({ clientX }) {
  const { left, width } = canvas.getBoundingClientRect();
  return clamped(Math.round((100 * (clientX - left)) / width), 0, 100);
}

/** Whether a pointer is on the seam of two rungs. */
function isOnSeam({ clientX }) {
  const { left, width } = canvas.getBoundingClientRect();
  return !seam.hidden && Math.abs(clientX - left - (live.state.wipe / 100) * width) < SEAM;
}

/** Gives the wheel to the picture, or back to the page. The focus is not enough: the scene gets it when it starts, and
 * the page must scroll on. */
const hold = (on) => canvas.classList.toggle('held', on);
canvas.addEventListener('blur', () => hold(false));

const fingers = new Map();
let wiping = false;
/** What a drag has changed, as it was before. */
let undragged = null;
canvas.addEventListener('pointerdown', (event) => {
  // Other buttons are the browser's: what their menu swallows would never end.
  if (event.button !== 0) return;
  canvas.setPointerCapture(event.pointerId);
  // A finger has no wheel, and gives no focus, by whose end the wheel would be free again.
  if (event.pointerType !== 'touch') hold(true);
  wiping = fingers.size === 0 && isOnSeam(event);
  fingers.set(event.pointerId, event);
});
for (const end of ['pointerup', 'pointercancel']) {
  canvas.addEventListener(end, ({ pointerId }) => {
    fingers.delete(pointerId);
    const isCancelled = end === 'pointercancel';
    // The browser scrolls the page by it instead, which it sees after some pixels.
    if (isCancelled && undragged) set(undragged);
    if (isCancelled || fingers.size === 0) undragged = null;
  });
}
canvas.addEventListener('pointermove', (event) => {
  const before = fingers.get(event.pointerId);
  canvas.classList.toggle('on-seam', before ? wiping : isOnSeam(event));
  if (!before) return;
  const apart = () => {
    const [first, second] = fingers.values();
    return Math.hypot(first.clientX - second.clientX, first.clientY - second.clientY);
  };
  const width = fingers.size === 2 && apart();
  // Each of two fingers turns half as far.
  const turn = width ? 0.2 : 0.4;
  fingers.set(event.pointerId, event);
  const { wipe, polar, azimuth, distance } = live.state;
  undragged ??= { wipe, polar, azimuth, distance };
  if (wiping) return void set({ wipe: wipeAt(event) });
  const share = width ? width / apart() : 1;
  move(turn * (before.clientY - event.clientY), turn * (before.clientX - event.clientX), share);
});
// One finger up or down scrolls the page, which `touch-action` leaves to the browser; two are the scene's.
for (const kind of ['touchstart', 'touchmove']) {
  // Once the page scrolls it does so to its end.
  const take = (event) => event.touches.length > 1 && event.cancelable && event.preventDefault();
  canvas.addEventListener(kind, take, { passive: false });
}
canvas.addEventListener('wheel', (event) => {
  // With Ctrl too, for by that one enlarges the page.
  if (!canvas.classList.contains('held')) return;
  event.preventDefault();
  move(0, 0, Math.exp(0.001 * clamped(event.deltaY, -200, 200)));
}, { passive: false });
const keys = {
  ArrowLeft: [0, -5], ArrowRight: [0, 5], ArrowUp: [-5, 0], ArrowDown: [5, 0], '+': [0, 0, 1 / 1.1], '-': [0, 0, 1.1],
};
canvas.addEventListener('keydown', (event) => {
  if (event.key === 'Escape') hold(false);
  if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  move(...keys[event.key]);
});

// Not by its name, which an effect may have too.
const picker = one('input[type="file"]');

/** Takes a file that was dropped, or says why not. */
function dropped(file) {
  if (!picker) tell('This scene takes no environment.');
  else if (canvas.hidden) tell('Start the scene first, then drop the file again.');
  else lightBy(file);
}

const stage = one('.live-picture');
for (const kind of ['dragover', 'dragleave', 'drop']) {
  section.addEventListener(kind, (event) => {
    // Otherwise the browser leaves the page for the file.
    event.preventDefault();
    stage.classList.toggle('over', kind === 'dragover' && !canvas.hidden && picker !== null);
    if (kind === 'drop' && event.dataTransfer.files[0]) dropped(event.dataTransfer.files[0]);
  });
}

window.addEventListener('hashchange', () => {
  const fragment = location.hash.slice(1);
  if (live?.device && asked(fragment).length > 0) set(parsed(fragment));
  reflectLink();
});
run.addEventListener('click', start);
run.hidden = false;
reflectLink();
if (!navigator.gpu) tell('This browser has no WebGPU, so the picture that the renderer draws stands here.');

/** For the console and for tests: all promises are kept when the picture is shown. */
gallery.live = {
  ready,
  start,
  set,
  measure,
  get state() {
    return structuredClone(live.state);
  },
  get device() {
    return live.device;
  },
  get manifest() {
    return live.manifest;
  },
  light,
  shader,
  readback,
};
