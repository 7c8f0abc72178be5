// The controls of a live page: they change the state of `Live`, which the address's fragment holds.

const section = document.querySelector('section.live');
const all = (selector) => [...section.querySelectorAll(selector)];
const one = (selector) => section.querySelector(selector);
const input = (name) => one(`[name="${name}"]`);
const [canvas, image, run, note] = ['canvas', 'img', '.live-run', '.live-note'].map(one);
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

const round = (value) => Number(value.toFixed(2));
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
  const number = (name) => Number.parseFloat(asked.get(name));
  if (Number.isFinite(number('wipe'))) state.wipe = clamped(number('wipe'), 0, 100);
  for (const name of Object.keys(toggles)) if (asked.has(name)) state.on[name] = asked.get(name) === 'on';
  for (const [name, { values }] of Object.entries(sliders)) {
    if (Number.isFinite(number(name))) state.steps[name] = nearest(values, number(name));
  }
  const view = (asked.get('view') ?? '').split(',').map(Number);
  return view.length === 3 && view.every(Number.isFinite) ? { ...state, ...placed(...view) } : state;
}

/** The fragment that holds a state: what is not as at the start. */
function fragment() {
  const { start, state, manifest } = live;
  const found = {};
  const keep = (name, value, usual, text) => value !== usual && (found[name] = text);
  for (const name of ['rung', 'other', 'wipe']) keep(name, state[name], start[name], state[name]);
  for (const [name, on] of Object.entries(state.on)) keep(name, on, start.on[name], on ? 'on' : 'off');
  for (const [name, step] of Object.entries(state.steps)) {
    keep(name, step, start.steps[name], manifest.sliders[name].values[step]);
  }
  if (live.isTurned) found.view = [state.polar, state.azimuth, state.distance].map(round).join();
  return new URLSearchParams(found).toString();
}

/** The command that draws it, as far as there are options for it. */
function command() {
  const { manifest, start, state } = live;
  const words = ['./cook render', scene, '--rung', state.rung, '--samples', manifest.samples];
  for (const name of manifest.rungs[state.rung].toggles) {
    words.push(manifest.toggles[name].options[state.on[name] ? 'on' : 'off']);
  }
  for (const [name, { option, values }] of Object.entries(manifest.sliders)) {
    if (option && state.steps[name] !== start.steps[name]) words.push(option, values[state.steps[name]]);
  }
  if (live.isTurned) words.push('--from', `${round(state.polar)},${round(state.azimuth)}`);
  return words.filter((word) => word !== '').join(' ');
}

/** Shows the state in the controls, the command and the address. */
function reflect() {
  const { manifest, state } = live;
  const rungs = [state.rung, state.other].map((name) => manifest.rungs[name]);
  for (const name of ['rung', 'other', 'wipe']) input(name).value = state[name];
  one('[data-wipe]').hidden = !state.other;
  one('[data-wipe] output').textContent = `${state.wipe} %`;
  for (const box of all('[data-toggle]')) {
    box.checked = state.on[box.name];
    box.disabled = !rungs.some((rung) => rung?.toggles.includes(box.name));
  }
  for (const [name, { values, unit, start }] of Object.entries(manifest.sliders)) {
    const text = `${Number(values[state.steps[name]].toPrecision(3))} ${unit}`.trim();
    input(name).value = state.steps[name];
    input(name).disabled = !rungs.some((rung) => rung?.moves.some(({ slider }) => slider === name));
    input(name).setAttribute('aria-valuetext', text);
    one(`[data-slider="${name}"] output`).textContent = text;
    one(`[data-slider="${name}"] [data-reset]`).disabled = state.steps[name] === start;
  }
  one('.live-command code').textContent = command();
  if (fragment() !== location.hash.slice(1)) history.replaceState(null, '', `#${fragment()}`);
}

// Drawing: never more than the device keeps up with.

let [drawing, wanted] = [null, false];

/** Draws, and once more if the state changed meanwhile. */
async function drawn() {
  do {
    wanted = false;
    await new Promise(requestAnimationFrame);
    await live.draw();
  } while (wanted);
}

/** Changes the state, and draws; the promise is kept when it is shown. */
function set(changes = {}) {
  Object.assign(live.state, changes);
  reflect();
  one('.live-time').textContent = '';
  wanted = true;
  drawing ??= drawn()
    .then(() => note.classList.contains('failed') && tell(''))
    .finally(() => (drawing = null));
  return drawing.catch(failed);
}

/** Says why it does not run; the picture stands there again. */
function failed(error) {
  const reason = error.message.split('\n')[0].replace(/[.\s]+$/, '');
  tell(`${reason[0]?.toUpperCase()}${reason.slice(1)}. The picture above is the one that the renderer draws.`, true);
  [canvas.hidden, image.hidden, run.hidden] = [true, false, false];
  one('.live-controls').disabled = true;
  settle.reject(error);
}

let [losses, since] = [0, 0];

/** Replaces a lost device by another one, but not for ever. */
async function lost(message) {
  losses = performance.now() - since > LASTING ? 1 : losses + 1;
  if (losses > MOST_LOSSES) return failed(new Error('The graphics device was lost again and again'));
  tell(`The graphics device was lost, so the scene starts on a new one. ${message}`, true);
  await drawing?.catch(() => {});
  return begin();
}

/** Draws on a new device. */
async function begin() {
  try {
    since = performance.now();
    await live.open(lost);
    await live.draw();
    [canvas.hidden, image.hidden, run.hidden] = [false, true, true];
    one('.live-controls').disabled = false;
    reflect();
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
  try {
    if (!navigator.gpu) throw new Error('This browser has no WebGPU');
    live ??= new Live(await gallery.load(`live/${scene}`), canvas);
    Object.assign(live.state, parsed(location.hash.slice(1)));
    losses = 0;
    await begin();
    canvas.focus({ preventScroll: true });
  } catch (error) {
    failed(error);
  }
  run.disabled = false;
}

// What one does.

/** Milliseconds that each rung that is shown takes for a frame with all its passes. */
async function times() {
  const found = [];
  for (const { name, frame } of live.sides) found.push({ rung: name, ms: await frame.time() });
  return found;
}

/** The shaders that draw the scene by the first rung, as they are compiled. */
function shader() {
  const [{ frame }] = live.sides;
  const { draws } = frame.rows.passes.find(({ name }) => name === 'scene');
  return [...new Set(draws.map(({ pipeline }) => frame.texts[pipeline]))].join('\n');
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
async function measure() {
  const { manifest } = live;
  await drawing;
  tell('Measuring …');
  const measured = await times();
  one('.live-time').textContent = measured.map(({ rung, ms }) => `${rung}: ${ms.toFixed(2)} ms on your GPU`).join(', ');
  tell('');
  for (const { rung, ms } of measured.filter(({ rung }) => manifest.rungs[rung].error !== null)) {
    for (const plot of document.querySelectorAll(`svg.plot[data-ladder="${manifest.ladder}"]`)) {
      gallery.plotPoint?.(plot, ms, manifest.rungs[rung].error, `${rung} on your GPU: ${ms.toFixed(2)} ms`);
    }
  }
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
    await light(await gallery.decodeEnvironment(await file.arrayBuffer(), file.name));
    tell(`Lit by ${file.name}.`);
  } catch (error) {
    tell(error.message, true);
  }
}

async function copied(text, what) {
  tell((await gallery.copy(text)) ? `${what} is in the clipboard.` : `${what} could not be copied.`);
}

const actions = {
  time: measure,
  shader: () => copied(shader(), 'The shader'),
  command: () => copied(one('.live-command code').textContent, 'The command'),
  start: () => set(structuredClone(live.start)),
};
for (const button of all('[data-do]')) button.addEventListener('click', () => actions[button.dataset.do]());

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

const fingers = new Map();
canvas.addEventListener('pointerdown', (event) => {
  canvas.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, event);
});
for (const end of ['pointerup', 'pointercancel']) {
  canvas.addEventListener(end, ({ pointerId }) => fingers.delete(pointerId));
}
canvas.addEventListener('pointermove', (event) => {
  const before = fingers.get(event.pointerId);
  if (!before) return;
  const apart = () => {
    const [one, other] = fingers.values();
    return Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY);
  };
  const distance = fingers.size === 2 && apart();
  fingers.set(event.pointerId, event);
  if (distance) move(0, 0, distance / apart());
  else move(0.4 * (before.clientY - event.clientY), 0.4 * (before.clientX - event.clientX));
});
canvas.addEventListener('wheel', (event) => {
  event.preventDefault();
  move(0, 0, Math.exp(0.001 * clamped(event.deltaY, -200, 200)));
}, { passive: false });
const keys = {
  ArrowLeft: [0, -5], ArrowRight: [0, 5], ArrowUp: [-5, 0], ArrowDown: [5, 0], '+': [0, 0, 1 / 1.1], '-': [0, 0, 1.1],
};
canvas.addEventListener('keydown', (event) => {
  if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  move(...keys[event.key]);
});

const stage = one('.live-picture');
for (const kind of ['dragover', 'dragleave', 'drop']) {
  stage.addEventListener(kind, (event) => {
    if (!live?.device || !input('environment')) return;
    event.preventDefault();
    stage.classList.toggle('over', kind === 'dragover');
    if (kind === 'drop' && event.dataTransfer.files[0]) lightBy(event.dataTransfer.files[0]);
  });
}

window.addEventListener('hashchange', () => live?.device && set(parsed(location.hash.slice(1))));
run.addEventListener('click', start);
run.hidden = false;
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
