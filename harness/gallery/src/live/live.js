// Draws a live scene: the frames that Rust exported, with the fields that sliders and camera say. It knows buffers,
// fields and passes, and no technique. `Frame` is docs/engines/frame.js; live_page.js has the page's controls.

/** Two frames side by side on a canvas, drawn as a state says:
 * `rung` and `other`, names of rungs, the second may be empty; `wipe`, the first one's share in percent; `on`, whether
 * each effect is on; `steps`, the step of each slider; `polar`, `azimuth` and `distance` of the eye. */
class Live {
  #files = new Map();
  /** The frames that are drawn, at the left and at the right. */
  sides = [];
  /** A picture that lights the scene: its width, height and texels. */
  environment = null;

  constructor(manifest, canvas) {
    Object.assign(this, { manifest, canvas });
    const { toggles, sliders, orbit } = manifest;
    const each = (of, value) => Object.fromEntries(Object.entries(of).map(([name, row]) => [name, value(row)]));
    const { polar, azimuth, distance } = orbit;
    const [on, steps] = [each(toggles, (row) => row.on), each(sliders, (row) => row.start)];
    /** The state that the scene starts with. */
    this.start = { rung: manifest.rung, other: '', wipe: 50, on, steps, polar, azimuth, distance };
    this.state = structuredClone(this.start);
  }

  /** Takes a new device; `lost` is called when it is gone. */
  async open(lost) {
    const { canvas } = this;
    if (!navigator.gpu) throw new Error('This browser has no WebGPU');
    const adapter = await navigator.gpu.requestAdapter();
    if (!adapter) throw new Error('This browser has WebGPU, but gives no graphics device to it');
    const requiredFeatures = ['timestamp-query'].filter((name) => adapter.features.has(name));
    this.device = await adapter.requestDevice({ requiredFeatures });
    [this.limits, this.adapter] = [adapter.limits, adapter.info];
    this.device.addEventListener('uncapturederror', ({ error }) => (this.error ??= error));
    this.device.lost.then(({ message }) => lost(message));
    this.sides = [];
    const { COPY_DST, COPY_SRC } = GPUTextureUsage;
    const size = [canvas.width, canvas.height];
    this.shown = this.device.createTexture({ size, format: 'rgba8unorm', usage: COPY_DST | COPY_SRC });
    this.context = canvas.getContext('webgpu');
    // The picture is encoded for the screen already, so it is copied as it is.
    this.context.configure({ device: this.device, format: 'rgba8unorm', usage: COPY_DST, alphaMode: 'opaque' });
  }

  /** Draws what is chosen: the rung at the left of the wipe, the other one at its right. */
  async draw() {
    const { device, shown, state } = this;
    const next = [await this.#side(state.rung)];
    if (state.other && state.other !== state.rung) next.push(await this.#side(state.other));
    this.sides.filter((side) => !next.includes(side)).forEach(({ frame }) => frame.destroy());
    this.sides = next;
    for (const side of next) {
      this.#write(side);
      side.frame.update();
    }
    const { width, height } = shown;
    const wipe = next.length > 1 ? Math.round((state.wipe / 100) * width) : width;
    const encoder = device.createCommandEncoder();
    const copy = (texture, to, left, right) => {
      const origin = [left, 0];
      encoder.copyTextureToTexture({ texture, origin }, { texture: to, origin }, [right - left, height]);
    };
    copy(next[0].picture, shown, 0, wipe);
    copy(next.at(-1).picture, shown, wipe, width);
    copy(shown, this.context.getCurrentTexture(), 0, width);
    device.queue.submit([encoder.finish()]);
    await device.queue.onSubmittedWorkDone();
    if (this.error) throw this.error;
  }

  /** Whether the eye is not where it starts. */
  get isTurned() {
    return ['polar', 'azimuth', 'distance'].some((name) => this.state[name] !== this.start[name]);
  }

  /** Reads a file of the frames' data; each is loaded once. */
  async #read(file, as) {
    if (!this.#files.has(file)) this.#files.set(file, gallery.bytes(`live/${file}`));
    const bytes = await this.#files.get(file);
    if (as === 'arrayBuffer') return bytes;
    const text = new TextDecoder().decode(bytes);
    return as === 'json' ? JSON.parse(text) : text;
  }

  /** A frame of the frames' data. */
  load(file) {
    const read = (asked, as) => this.#read(asked === 'frame.json' ? file : asked, as);
    return Frame.load(this.device, read, this.limits);
  }

  /** The frame of a rung with the effects that are on, loaded unless it is there already. */
  async #side(name) {
    const { environment, manifest, state } = this;
    const rung = manifest.rungs[name];
    const effects = rung.toggles.filter((effect) => state.on[effect]);
    if (environment) effects.push(manifest.environment.effect);
    const file = rung.frames[effects.join('+')];
    const there = this.sides.find((side) => side.file === file && side.environment === environment);
    if (there) return there;
    const frame = await this.load(file);
    const named = (of) => frame.rows.resources.findIndex((row) => row.name === of);
    const texture = environment ? named(manifest.environment.texture) : -1;
    if (texture >= 0) frame.replace(texture, [environment.width, environment.height], environment.texels.buffer);
    const picture = frame.resources[named('encoded picture')];
    return { name, file, environment, rung, frame, picture, written: new Map() };
  }

  /** What the camera's buffer holds: columns of the matrix to clip space, and the eye. */
  #view() {
    const { distance, polar, azimuth } = this.state;
    const { target, scale, centre, radius } = this.manifest.orbit;
    const [p, a] = [polar, azimuth].map((degrees) => (degrees * Math.PI) / 180);
    const back = [Math.sin(p) * Math.sin(a), Math.cos(p), Math.sin(p) * Math.cos(a)];
    const right = [Math.cos(a), 0, -Math.sin(a)];
    const up = [-Math.cos(p) * Math.sin(a), Math.sin(p), -Math.cos(p) * Math.cos(a)];
    const dot = (one, other) => one.reduce((sum, part, axis) => sum + part * other[axis], 0);
    const eye = target.map((part, axis) => part + distance * back[axis]);
    const middle = dot(back, eye) - dot(back, centre);
    const far = Math.max(middle + 1.01 * radius, 1e-3 * radius);
    const near = Math.max(middle - 1.01 * radius, 1e-4 * far);
    const depth = far / (near - far);
    const row = (axis, factor, offset = 0) => [...axis.map((part) => part * factor), offset - factor * dot(axis, eye)];
    const rows = [row(right, scale), row(up, scale), row(back, depth, depth * near), row(back, -1)];
    return { clip: [0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column])), eye };
  }

  /** Writes what the state says into a frame's fields, where that is not what they hold. */
  #write({ frame, rung, written }) {
    const { manifest, start, state } = this;
    const values = new Map();
    const value = (place, field, element) => {
      const key = [place, field, element].join();
      if (!values.has(key)) values.set(key, { place, field, element, floats: [...frame.field(place, field, element)] });
      return values.get(key);
    };
    for (const { slider, at, nodes } of rung.moves) {
      const [now, usual] = [state, start].map(({ steps }) => Float32Array.from(nodes[steps[slider]]));
      for (const [buffer, nth, element, field] of at) {
        const place = frame.buffers(buffer)[nth];
        if (place === undefined) continue;
        const { floats } = value(place, field, element);
        now.forEach((float, part) => (floats[part] += float - usual[part]));
      }
    }
    const { buffer, clip, eye } = manifest.orbit;
    const seen = this.isTurned ? this.#view() : null;
    for (const place of frame.buffers(buffer)) {
      for (const [field, floats] of [[clip, seen?.clip], [eye, seen?.eye]]) {
        const of = value(place, field, 0);
        of.floats = floats ?? of.floats;
      }
    }
    for (const [key, { place, field, element, floats }] of values) {
      const text = Float32Array.from(floats).join();
      const held = written.get(key) ?? frame.field(place, field, element).join();
      if (held !== text) frame.write(place, field, floats, element);
      written.set(key, text);
    }
  }
}
