// "Edit this function and check it": runs a function of the visitor's text on the visitor's GPU, and holds each
// result against the intervals that `cook gallery` exported. It knows no function: see gallery/rows/pack.rs.
'use strict';

(() => {
  /** Seconds after which a run counts as endless. */
  const PATIENCE = 60;

  /** What is wrong, in a sentence for the page. */
  class Problem extends Error {}
  /** The device is gone; a new one may do. */
  class Lost extends Error {}

  const word = new Uint32Array(1);
  const float = new Float32Array(word.buffer);
  const int = new Int32Array(word.buffer);

  const floatOf = (bits) => ((word[0] = bits), float[0]);

  /** The number that a word stands for. */
  const numberOf = (kind, bits) => {
    if (kind === 'f32') return floatOf(bits);
    if (kind === 'i32') return bits | 0;
    return kind === 'bool' ? Number(bits !== 0) : bits >>> 0;
  };

  /** The float that lies `steps` floats above the one of these bits; both zeros are one. */
  function stepped(bits, steps) {
    int[0] = bits;
    // The steps may have overflowed, so that the sum does too.
    const place = ((int[0] < 0 ? -0x80000000 - int[0] : int[0]) + steps) | 0;
    int[0] = place < 0 ? -0x80000000 - place : place;
    return float[0];
  }

  /** The unit in the last place of a float of this size. */
  function ulpOf(value) {
    float[0] = Math.min(Math.abs(value), 3.4028234663852886e38);
    // The conversion rounds, maybe up to the next power of two.
    if (float[0] > Math.abs(value)) word[0] -= 1;
    return 2 ** (Math.max(word[0] >>> 23, 1) - 150);
  }

  /** The shortest decimal that is this float. */
  function shortest(value) {
    if (!Number.isFinite(value)) return String(value);
    for (let digits = 1; digits < 9; digits++) {
      const text = value.toPrecision(digits);
      if (Math.fround(Number(text)) === value) return String(Number(text));
    }
    return String(Number(value.toPrecision(9)));
  }

  const spelled = (kind, value) => {
    if (kind === 'bool') return value ? 'true' : 'false';
    return kind === 'f32' ? shortest(Math.fround(value)) : String(value);
  };

  const listed = (texts) => (texts.length === 1 ? texts[0] : `(${texts.join(', ')})`);

  async function inflated(base64) {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  /** Takes columns of words from bytes in planes. */
  function columns(bytes) {
    let at = 0;
    return (count) => {
      const plane = (index) => bytes.subarray(at + index * count, at + (index + 1) * count);
      const [a, b, c, d] = [0, 1, 2, 3].map(plane);
      at += 4 * count;
      return Uint32Array.from(a, (byte, row) => byte | (b[row] << 8) | (c[row] << 16) | (d[row] << 24));
    };
  }

  const kindsOf = (parts) => parts.flatMap((part) => Array(part.length).fill(part.kind));

  const opened = new Map();

  /** A function's data with its columns; loaded once. */
  function open(name) {
    if (!opened.has(name)) {
      const found = read(name);
      found.catch(() => opened.delete(name));
      opened.set(name, found);
    }
    return opened.get(name);
  }

  async function read(name) {
    const data = await gallery.load(`rows/${name}`);
    const take = columns(await inflated(data.rows));
    const kinds = kindsOf(data.result.parts);
    const inputs = data.input.offsets.map(() => take(data.count));
    const cases = take(data.count);
    const exact = kinds.map((kind) => {
      const bits = take(data.count);
      if (kind !== 'f32') return { bits, numbers: Array.from(bits, (each) => numberOf(kind, each)) };
      const lost = take(data.count);
      const number = (each, row) => floatOf(each) + ((lost[row] | 0) / 256) * ulpOf(floatOf(each));
      return { bits, numbers: Array.from(bits, number) };
    });
    const total = cases.reduce((sum, count) => sum + count, 0);
    const rowOf = Array.from(cases).flatMap((count, row) => Array(count).fill(row));
    const ends = kinds.map((kind, index) => {
      const below = take(total);
      if (kind !== 'f32') {
        const same = Array.from(below, (each) => numberOf(kind, each));
        return { low: same, high: same };
      }
      const above = take(total);
      const bits = (at) => exact[index].bits[rowOf[at]];
      const low = Array.from(below, (steps, at) => stepped(bits(at), -(steps | 0)));
      return { low, high: Array.from(above, (steps, at) => stepped(bits(at), steps | 0)) };
    });
    return { ...data, kinds, inputs, cases, exact, ends };
  }

  /** How far a number lies from the expected one, as a share of how far it may; it holds up to 1. */
  function share(kind, value, exact, low, high) {
    const holds = value >= low && value <= high;
    if (kind !== 'f32') return holds ? 0 : Infinity;
    if (holds && value === exact) return 0;
    const ratio = Math.abs(value - exact) / Math.max(value < exact ? exact - low : high - exact, 0);
    if (holds) return Math.min(ratio, 1);
    return Number.isFinite(value) ? Math.max(ratio, 1 + Number.EPSILON) : Infinity;
  }

  /** Judges the results, a list of numbers for each row: how many rows hold, and which is the worst. */
  function judge(rows, results) {
    let [held, at, worst] = [0, 0, null];
    for (let row = 0; row < rows.count; row++) {
      // Any of the cases may hold; the first is the oracle's own, and in another the expected result says nothing.
      const first = at;
      let [ratio, entry] = [Infinity, at];
      for (const end = at + rows.cases[row]; at < end; at++) {
        const shares = rows.kinds.map((kind, index) => {
          const { low, high } = rows.ends[index];
          return share(kind, results[row][index], rows.exact[index].numbers[row], low[at], high[at]);
        });
        const largest = Math.max(...shares);
        if (largest < ratio && ratio > 1) [ratio, entry] = [at > first && largest <= 1 ? 0 : largest, at];
      }
      if (ratio <= 1) held++;
      if (!worst || ratio > worst.ratio) worst = { row, ratio, entry };
    }
    return { rows: rows.count, held, worst: described(rows, worst, results[worst.row]) };
  }

  /** The worst row in words. */
  function described(rows, { row, ratio, entry }, result) {
    let at = 0;
    const inputs = rows.arguments.map(({ name, parts }) => {
      const texts = parts.map(({ path, kind, length }) => {
        const values = rows.inputs.slice(at, (at += length)).map((column) => numberOf(kind, column[row]));
        const label = path.startsWith('[') || path === '' ? path : `${path} `;
        return `${label}${listed(values.map((value) => spelled(kind, value)))}`;
      });
      return { name, text: texts.join(', ') };
    });
    let from = 0;
    const parts = rows.result.parts.map((part) => {
      const places = Array.from({ length: part.length }, () => from++);
      return compared(part, {
        got: places.map((place) => result[place]),
        exact: places.map((place) => rows.exact[place].numbers[row]),
        low: places.map((place) => rows.ends[place].low[entry]),
        high: places.map((place) => rows.ends[place].high[entry]),
      });
    });
    return { row, label: labelled(rows, row), holds: ratio <= 1, ratio, inputs, parts };
  }

  /** A part of a result: expected, got, error and tolerance. */
  function compared(part, { got, exact, low, high }) {
    const texts = (values) => listed(values.map((value) => spelled(part.kind, value)));
    const same = got.every((value, index) => value === exact[index]);
    const found = { name: part.path, expected: texts(exact), got: texts(got), bound: part.bound };
    const ends = low.map((least, index) => ({ least, greatest: high[index] }));
    const holds = ends.every(({ least, greatest }, index) => got[index] >= least && got[index] <= greatest);
    const other = holds ? 'none: beside a threshold either holds' : 'another value';
    if (part.kind !== 'f32') return { ...found, holds, error: same ? 'none' : other, allowed: texts(low) };
    const elsewhere = holds && ends.some(({ least, greatest }, index) => exact[index] < least || exact[index] > greatest);
    if (elsewhere) return { ...found, holds, error: 'none in this case', allowed: spanned(ends) };
    const error = Math.max(...got.map((value, index) => Math.abs(value - exact[index])));
    const scale = Math.max(...exact.map(Math.abs));
    return { ...found, holds, error: inWords(error, scale, part.bound, got), allowed: spanned(ends) };
  }

  const brief = (value) => String(Number(value.toPrecision(9)));
  const spanned = (ends) => listed(ends.map(({ least, greatest }) => `${brief(least)} … ${brief(greatest)}`));

  /** An error in the units of its bound. */
  function inWords(error, scale, bound, got) {
    if (!got.every(Number.isFinite)) return 'not finite';
    const amount = (value) => String(Number(value.toPrecision(3)));
    const texts = [];
    if (/ulp|backward/.test(bound)) texts.push(`${amount(error / ulpOf(scale))} ulp`);
    if (/rel/.test(bound) && scale > 0) texts.push(`${amount(error / scale)} rel`);
    if (/abs/.test(bound) || texts.length === 0) texts.push(`${amount(error)} abs`);
    return texts.join(' = ');
  }

  function labelled({ hard, edges, count }, row) {
    if (row < hard.length) return `hard case: ${hard[row]}`;
    const edge = row - (count - edges.length);
    return edge >= 0 ? `edge: ${edges[edge]}` : `input ${row - hard.length}`;
  }

  let known = null;

  /** A device, which all checks share until it is lost. */
  function device() {
    known ??= asked().catch((error) => {
      known = null;
      throw error;
    });
    return known;
  }

  async function asked() {
    if (!navigator.gpu) {
      throw new Problem('This browser has no WebGPU, which the check runs on; Chrome, Edge and Safari have it, and Firefox on most systems.');
    }
    const adapter = await navigator.gpu.requestAdapter();
    if (!adapter) throw new Problem('The browser gives this page no GPU; see chrome://gpu or about:support for why.');
    const found = await adapter.requestDevice();
    found.lost.then(() => (known = null));
    const { vendor, architecture, description } = adapter.info ?? {};
    return { device: found, name: description || [vendor, architecture].filter(Boolean).join(' ') || 'this GPU' };
  }

  /** A promise's value, unless the device is lost or takes too long before it. */
  function before(gpu, promise) {
    let timer;
    const lost = gpu.lost.then(({ message }) => {
      throw new Lost(message);
    });
    const late = new Promise((_, reject) => {
      timer = setTimeout(() => {
        reject(new Problem(`The GPU gave no result within ${PATIENCE} s: a loop without an end?`));
        gpu.destroy();
      }, 1000 * PATIENCE);
    });
    return Promise.race([promise, lost, late]).finally(() => clearTimeout(timer));
  }

  /** The compiler's messages about a text; a line of null is in what the check appends. */
  async function messagesOf(module, text) {
    const lines = text.split('\n').length;
    const { messages } = await module.getCompilationInfo();
    return messages.map(({ type, message, lineNum, linePos }) => {
      if (lineNum >= 1 && lineNum <= lines) return { type, line: lineNum, column: linePos, text: message };
      const said = lineNum === 0 ? message : `${message} (in the call that the check appends: names and signatures must stay)`;
      return { type, line: null, column: null, text: said };
    });
  }

  /** Compiles the text with the function's kernel. */
  async function compiled(gpu, rows, text) {
    gpu.pushErrorScope('validation');
    const module = gpu.createShaderModule({ code: `${text}\n${rows.kernel}` });
    const messages = await before(gpu, messagesOf(module, text));
    const error = await before(gpu, gpu.popErrorScope());
    if (messages.some(({ type }) => type === 'error')) return { messages };
    if (error) return { messages: [...messages, { type: 'error', line: null, column: null, text: error.message }] };
    const descriptor = { layout: 'auto', compute: { module, entryPoint: rows.entry } };
    try {
      return { messages, pipeline: await before(gpu, gpu.createComputePipelineAsync(descriptor)) };
    } catch (fault) {
      if (fault.name !== 'GPUPipelineError') throw fault;
      return { messages: [...messages, { type: 'error', line: null, column: null, text: fault.message }] };
    }
  }

  /** The rows' words in the buffer that the kernel reads. */
  function packed({ input, inputs, count }) {
    const buffer = new Uint32Array((count * input.stride) / 4);
    input.offsets.forEach((offset, index) => {
      inputs[index].forEach((bits, row) => (buffer[(row * input.stride + offset) / 4] = bits));
    });
    return buffer;
  }

  /** The kernel's results, a list of numbers for each row. */
  async function dispatched(gpu, rows, pipeline) {
    const { STORAGE, COPY_SRC, COPY_DST, MAP_READ } = GPUBufferUsage;
    const size = rows.count * rows.output.stride;
    const contents = packed(rows);
    const from = gpu.createBuffer({ size: contents.byteLength, usage: STORAGE | COPY_DST });
    const to = gpu.createBuffer({ size, usage: STORAGE | COPY_SRC });
    const seen = gpu.createBuffer({ size, usage: COPY_DST | MAP_READ });
    gpu.pushErrorScope('validation');
    gpu.queue.writeBuffer(from, 0, contents);
    const encoder = gpu.createCommandEncoder();
    const pass = encoder.beginComputePass();
    const entries = [from, to].map((buffer, binding) => ({ binding, resource: { buffer } }));
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, gpu.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
    pass.dispatchWorkgroups(Math.ceil(rows.count / rows.workgroup));
    pass.end();
    encoder.copyBufferToBuffer(to, 0, seen, 0, size);
    gpu.queue.submit([encoder.finish()]);
    const error = await before(gpu, gpu.popErrorScope());
    if (error) throw new Problem(`The GPU refused the check: ${error.message}`);
    await before(gpu, seen.mapAsync(GPUMapMode.READ));
    const words = new Uint32Array(seen.getMappedRange().slice(0));
    [from, to, seen].forEach((buffer) => buffer.destroy());
    const { stride, offsets } = rows.output;
    const number = (row, offset, index) => numberOf(rows.kinds[index], words[(row * stride + offset) / 4]);
    return Array.from({ length: rows.count }, (_, row) => offsets.map((offset, index) => number(row, offset, index)));
  }

  async function once(rows, text) {
    const { device: gpu, name } = await device();
    const { messages, pipeline } = await compiled(gpu, rows, text);
    if (!pipeline) return { rows: rows.count, held: 0, worst: null, messages, adapter: name };
    return { ...judge(rows, await dispatched(gpu, rows, pipeline)), messages, adapter: name };
  }

  /** Whether a failure comes from a device that is gone, which a call may notice first. */
  const isLoss = async (error) => {
    if (error instanceof Problem) return false;
    await new Promise((resolve) => setTimeout(resolve, 100));
    return error instanceof Lost || known === null;
  };

  /** Checks a text's function: how many of its rows hold, the worst of them, and the compiler's messages. */
  gallery.check = async (name, text) => {
    const rows = await open(name);
    try {
      return await once(rows, text);
    } catch (error) {
      if (!(await isLoss(error))) throw error;
    }
    try {
      return await once(rows, text);
    } catch (error) {
      if (!(await isLoss(error))) throw error;
      throw new Problem(`The GPU was lost twice during the check: a loop without an end does that. ${error.message}`);
    }
  };
})();
