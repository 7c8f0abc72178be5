// Runs a Lapidary frame on WebGPU: what `./cook frame` writes, as docs/frame.md describes it.
// It needs nothing but this file.
//
//   const frame = await Frame.load(device, 'url/of/folder');
//   const { 'linear picture': picture } = await frame.run();
//
// or, for a frame after a frame, without reading anything back:
//
//   frame.draw((pass) => pass.kind !== 'read');
//
// or what has changed alone, after fields were written:
//
//   frame.write(frame.buffers('view')[0], 'eye', [0, 0, 5]);
//   frame.update();

/** The version of frame.json that this file reads. */
const VERSION = 4;

/** Bytes of a texel, by its format's name: `rgba16float` has four channels of 16 bits. */
function texelBytes(format) {
  const [, channels, bits] = /^(rgba|rg|r|depth)(\d+)/.exec(format);
  return ((channels === 'depth' ? 1 : channels.length) * bits) / 8;
}

/** Or-s the flags of WebGPU's names. */
const flags = (names, all) => names.reduce((sum, name) => sum | all[name], 0);

/** Reads the files of a folder by `fetch`, as `json`, `text` or `arrayBuffer`. */
const fetching = (folder) => async (file, as) => {
  const path = file.split('/').map(encodeURIComponent).join('/');
  const response = await fetch(`${folder}/${path}`);
  if (!response.ok) throw new Error(`${folder}/${file}: ${response.status}`);
  return response[as]();
};

export class Frame {
  /** Makes everything that a frame needs; nothing is drawn yet. It comes from a folder's URL, or by a function of a
   * file's name and `json`, `text` or `arrayBuffer`. `limits` are those of the device. */
  static async load(device, from, limits = device.limits) {
    const frame = new Frame();
    const read = typeof from === 'string' ? fetching(from) : from;
    frame.device = device;
    frame.rows = await read('frame.json', 'json');
    if (frame.rows.version !== VERSION) throw new Error(`a frame of version ${frame.rows.version}, not ${VERSION}`);
    const { resources, pipelines, bind_groups } = frame.rows;
    const bytes = (file) => (file === null ? null : read(file, 'arrayBuffer'));
    frame.contents = await Promise.all(resources.map((row) => bytes(row.contents ?? null)));
    frame.texts = await Promise.all(pipelines.map((row) => read(row.wgsl, 'text')));
    frame.#check(limits);
    frame.resources = resources.map((row, place) => frame.#resource(row, frame.contents[place]));
    frame.pipelines = await Promise.all(pipelines.map((row, place) => frame.#pipeline(row, frame.texts[place])));
    frame.groups = bind_groups.map((row) => frame.#group(row));
    return frame;
  }

  /** Runs all passes, and returns the pictures by name: width, height and texels, row by row. */
  async run() {
    const pictures = {};
    for (const { name, format, size } of this.rows.pictures) {
      const [width, height] = size;
      const bytes = new ArrayBuffer(width * height * texelBytes(format));
      const texels = format.endsWith('32float') ? new Float32Array(bytes) : new Uint8Array(bytes);
      pictures[name] = { width, height, texels };
    }
    for (const pass of this.rows.passes) {
      this.draw((other) => other === pass);
      // The next tile is copied to the same buffer, so this one is read first.
      if (pass.kind === 'read') await this.#read(pass, pictures[pass.picture]);
    }
    return pictures;
  }

  /** Submits the passes that a test selects, by default all that do not read back. A set of two timestamp queries gets
   * when they begin and when they end. */
  draw(selects = (pass) => pass.kind !== 'read', querySet = null) {
    const encoder = this.device.createCommandEncoder();
    const passes = this.rows.passes.filter(selects);
    const timed = passes.filter(({ kind }) => querySet && (kind === 'render' || kind === 'compute'));
    for (const pass of passes) {
      const begins = pass === timed[0] && { beginningOfPassWriteIndex: 0 };
      const ends = pass === timed.at(-1) && { endOfPassWriteIndex: 1 };
      this.#encode(encoder, pass, begins || ends ? { querySet, ...begins, ...ends } : undefined);
    }
    this.device.queue.submit([encoder.finish()]);
  }

  /** Submits the passes whose results change with what was written since the last time, which the frame lists for each
   * resource in `again`; all of them the first time, or if there is no list. */
  update() {
    const { again, passes } = this.rows;
    const all = passes.map((_, place) => place);
    const places = this.#changed && again ? [...this.#changed].flatMap((resource) => again[resource] ?? all) : all;
    this.#changed = new Set();
    this.draw((pass) => pass.kind !== 'read' && places.includes(passes.indexOf(pass)));
  }

  /** Milliseconds that the device takes for all passes, the median of some runs. If all together take over a second,
   * five are enough, and three if one alone does; a signal ends it after the run that is under way. It goes by the
   * device's own clock if that has the feature `timestamp-query`, by this page's otherwise. */
  async time(runs = 9, signal) {
    const clock = this.device.features.has('timestamp-query') ? this.#clock() : null;
    const times = [];
    for (const start = performance.now(); times.length < runs && !signal?.aborted; ) {
      const enough = times.some((time) => time > 1000) ? 3 : 5;
      if (times.length >= enough && performance.now() - start > 1000) break;
      await this.device.queue.onSubmittedWorkDone();
      const begin = performance.now();
      this.draw(undefined, clock?.queries);
      const passed = clock && (await clock.read());
      await this.device.queue.onSubmittedWorkDone();
      times.push(passed || performance.now() - begin);
    }
    clock?.destroy();
    return times.sort((a, b) => a - b)[times.length >> 1];
  }

  /** The buffers of a name that hold a struct; a name is shared by all tiles. */
  buffers(name) {
    const places = this.rows.resources.keys();
    return [...places].filter((place) => this.rows.resources[place].layout && this.rows.resources[place].name === name);
  }

  /** Where a field of a buffer stands, in the struct of this number. */
  #field(place, name, element) {
    const { bytes, fields } = this.rows.resources[place].layout;
    const { offset, type } = fields.find((field) => field.name === name);
    return { offset: element * bytes + offset, type };
  }

  /** The initial value of a field of a buffer, as floats. */
  field(place, name, element = 0) {
    const { offset, type } = this.#field(place, name, element);
    const count = { f32: 1, 'vec2<f32>': 2, 'vec3<f32>': 3, 'vec4<f32>': 4, 'mat4x4<f32>': 16 }[type];
    return new Float32Array(this.contents[place], offset, count);
  }

  /** Writes a field of a buffer. */
  write(place, name, floats, element = 0) {
    const { offset } = this.#field(place, name, element);
    this.device.queue.writeBuffer(this.resources[place], offset, Float32Array.from(floats));
    this.#changed?.add(place);
  }

  /** Gives a texture of one level another width, height and contents. */
  replace(place, [width, height], contents) {
    const row = this.rows.resources[place];
    row.size = [width, height, row.size[2]];
    this.resources[place].destroy();
    this.resources[place] = this.#resource(row, contents);
    this.groups = this.rows.bind_groups.map((row) => this.#group(row));
    this.#changed?.add(place);
  }

  /** Frees what the frame holds on the device. */
  destroy() {
    for (const resource of this.resources) resource.destroy?.();
  }

  /** Places of resources that were written since the last update; null before the first one. */
  #changed = null;

  /** Refuses a device that is too small. */
  #check(limits) {
    const { bind_groups, passes, pipelines, resources } = this.rows;
    const most = (rows, needs) => Math.max(0, ...rows.flatMap(needs));
    const sizes = (of) => resources.flatMap(({ dimension, size }) => (dimension === of ? [size] : []));
    const bytes = (usage) => most(resources, (row) => (row.usage?.includes(usage) ? (row.bytes ?? 0) : 0));
    const dispatches = passes.flatMap((pass) => pass.dispatches ?? []);
    const isStorage = ({ resource }) => resources[resource].usage?.includes('STORAGE');
    const entries = ({ groups }) => groups.flatMap((group) => bind_groups[group]?.entries ?? []);
    const needs = {
      maxTextureDimension2D: most(sizes('2d'), (size) => size.slice(0, 2)),
      maxTextureDimension3D: most(sizes('3d'), (size) => size),
      maxTextureArrayLayers: most(sizes('2d'), (size) => size[2]),
      maxBufferSize: most(resources, (row) => row.bytes ?? 0),
      maxStorageBufferBindingSize: bytes('STORAGE'),
      maxUniformBufferBindingSize: bytes('UNIFORM'),
      maxBindGroups: most(bind_groups, ({ group }) => group + 1),
      maxBindingsPerBindGroup: most(bind_groups, (row) => row.entries.map(({ binding }) => binding + 1)),
      // Two stages share those of a draw, and the frame does not say how.
      maxStorageBuffersPerShaderStage: most(dispatches, (dispatch) => entries(dispatch).filter(isStorage).length),
      maxColorAttachments: most(pipelines, (row) => row.targets?.length ?? 0),
      maxComputeWorkgroupsPerDimension: most(dispatches, ({ workgroups }) => workgroups ?? 0),
    };
    for (const [name, need] of Object.entries(needs)) {
      const numbers = `${name} is ${limits[name]}, and the frame needs ${need}`;
      if (limits[name] < need) throw new Error(`this graphics device is too small: its ${numbers}`);
    }
  }

  /** Two timestamps, and what reads the milliseconds between them. */
  #clock() {
    const { device } = this;
    const queries = device.createQuerySet({ type: 'timestamp', count: 2 });
    const buffer = (...usage) => device.createBuffer({ size: 16, usage: flags(usage, GPUBufferUsage) });
    const [resolved, mapped] = [buffer('QUERY_RESOLVE', 'COPY_SRC'), buffer('COPY_DST', 'MAP_READ')];
    const read = async () => {
      const encoder = device.createCommandEncoder();
      encoder.resolveQuerySet(queries, 0, 2, resolved, 0);
      encoder.copyBufferToBuffer(resolved, 0, mapped, 0, 16);
      device.queue.submit([encoder.finish()]);
      await mapped.mapAsync(GPUMapMode.READ);
      const [begin, end] = new BigUint64Array(mapped.getMappedRange());
      mapped.unmap();
      return Number(end - begin) / 1e6;
    };
    return { queries, read, destroy: () => [queries, resolved, mapped].forEach((held) => held.destroy()) };
  }

  #resource(row, contents) {
    const { device } = this;
    if (row.kind === 'sampler') {
      const [addressModeU, addressModeV] = row.address;
      const filters = { magFilter: row.filter, minFilter: row.filter, mipmapFilter: row.filter };
      return device.createSampler({ ...filters, addressModeU, addressModeV });
    }
    if (row.kind === 'buffer') {
      const usage = flags(row.usage, GPUBufferUsage);
      const buffer = device.createBuffer({ size: row.bytes, usage, mappedAtCreation: contents !== null });
      if (contents === null) return buffer;
      new Uint8Array(buffer.getMappedRange()).set(new Uint8Array(contents));
      buffer.unmap();
      return buffer;
    }
    const { size, format, dimension, levels } = row;
    const usage = flags(row.usage, GPUTextureUsage);
    const texture = device.createTexture({ size, format, dimension, usage, mipLevelCount: levels });
    for (let mipLevel = 0, offset = 0; contents !== null && offset < contents.byteLength; mipLevel++) {
      const [width, height] = size.map((texels) => Math.max(1, texels >> mipLevel));
      const layout = { offset, bytesPerRow: width * texelBytes(format), rowsPerImage: height };
      device.queue.writeTexture({ texture, mipLevel }, contents, layout, [width, height, size[2]]);
      offset += layout.bytesPerRow * height * size[2];
    }
    return texture;
  }

  #pipeline(row, code) {
    const module = this.device.createShaderModule({ label: row.name, code });
    const [first, second] = row.entries;
    if (row.kind === 'compute') {
      const compute = { module, entryPoint: first };
      return this.device.createComputePipelineAsync({ label: row.name, layout: 'auto', compute });
    }
    const component = (operation) => ({ srcFactor: 'one', dstFactor: 'one', operation });
    const blend = row.blend ? { color: component(row.blend.color), alpha: component(row.blend.alpha) } : undefined;
    return this.device.createRenderPipelineAsync({
      label: row.name,
      layout: 'auto',
      vertex: { module, entryPoint: first },
      primitive: { topology: 'triangle-list', frontFace: 'ccw', cullMode: row.cull },
      depthStencil: row.depth ? { format: row.depth, depthWriteEnabled: true, depthCompare: 'less' } : undefined,
      fragment: { module, entryPoint: second, targets: row.targets.map((format) => ({ format, blend })) },
    });
  }

  #group(row) {
    const entries = row.entries.map(({ binding, resource: place, dimension }) => {
      const [kind, resource] = [this.rows.resources[place].kind, this.resources[place]];
      if (kind === 'buffer') return { binding, resource: { buffer: resource } };
      return { binding, resource: kind === 'texture' ? resource.createView({ dimension }) : resource };
    });
    const layout = this.pipelines[row.pipeline].getBindGroupLayout(row.group);
    return this.device.createBindGroup({ layout, entries });
  }

  #encode(encoder, pass, timestampWrites) {
    const { resources } = this;
    if (pass.kind === 'render') {
      this.#render(encoder, pass, timestampWrites);
    } else if (pass.kind === 'compute') {
      this.#compute(encoder, pass, timestampWrites);
    } else if (pass.kind === 'clear') {
      encoder.clearBuffer(resources[pass.buffer], 0, pass.bytes);
    } else if (pass.kind === 'copy') {
      encoder.copyBufferToBuffer(resources[pass.from], 0, resources[pass.to], 0, pass.bytes);
    } else if (pass.kind === 'read') {
      const target = { buffer: resources[pass.buffer], bytesPerRow: pass.bytes_per_row };
      encoder.copyTextureToBuffer({ texture: resources[pass.texture] }, target, pass.size);
    } else {
      throw new Error(`a pass of kind ${pass.kind}`);
    }
  }

  #layer(place, baseArrayLayer) {
    return this.resources[place].createView({ dimension: '2d', baseArrayLayer, arrayLayerCount: 1, mipLevelCount: 1 });
  }

  #bind(encoder, draw) {
    encoder.setPipeline(this.pipelines[draw.pipeline]);
    draw.groups.forEach((group, number) => group !== null && encoder.setBindGroup(number, this.groups[group]));
  }

  #render(encoder, pass, timestampWrites) {
    const colorAttachments = pass.targets.map(({ texture, layer, clear }) => {
      const view = this.#layer(texture, layer);
      return { view, clearValue: clear ?? undefined, loadOp: clear ? 'clear' : 'load', storeOp: 'store' };
    });
    const depthStencilAttachment = pass.depth ? {
      view: this.#layer(pass.depth.texture, 0),
      depthClearValue: 1,
      depthLoadOp: pass.depth.load ? 'load' : 'clear',
      depthStoreOp: pass.depth.keep ? 'store' : 'discard',
    } : undefined;
    const render = encoder.beginRenderPass({ colorAttachments, depthStencilAttachment, timestampWrites });
    if (pass.viewport) render.setViewport(...pass.viewport, 0, 1);
    for (const draw of pass.draws) {
      this.#bind(render, draw);
      if (draw.scissor) render.setScissorRect(...draw.scissor);
      render.draw(draw.vertices, draw.instances);
    }
    render.end();
  }

  #compute(encoder, pass, timestampWrites) {
    const compute = encoder.beginComputePass({ timestampWrites });
    for (let time = 0; time < pass.repeat; time++) {
      for (const dispatch of pass.dispatches) {
        this.#bind(compute, dispatch);
        if (dispatch.indirect == null) compute.dispatchWorkgroups(...dispatch.workgroups);
        else compute.dispatchWorkgroupsIndirect(this.resources[dispatch.indirect], 0);
      }
    }
    compute.end();
  }

  /** Copies the rows of a buffer that was read to their place in the picture. */
  async #read(pass, picture) {
    const buffer = this.resources[pass.buffer];
    await buffer.mapAsync(GPUMapMode.READ);
    const Texels = picture.texels.constructor;
    const channels = picture.texels.length / (picture.width * picture.height);
    const [[width, height], [left, top]] = [pass.size, pass.at];
    const mapped = buffer.getMappedRange();
    for (let row = 0; row < height; row++) {
      const texels = new Texels(mapped, row * pass.bytes_per_row, width * channels);
      picture.texels.set(texels, ((top + row) * picture.width + left) * channels);
    }
    buffer.unmap();
  }
}
