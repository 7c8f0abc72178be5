// Reads a latitude-longitude map of radiance, a Radiance .hdr or an OpenEXR .exr file, told apart by content.
//
//   const { width, height, texels } = await gallery.decodeEnvironment(arrayBuffer, file.name);
//
// `texels` is a Float32Array of red, green, blue and 1, row by row from the top: linear radiance, finite and not
// negative. Any other file throws an Error with one sentence that says what is wrong and what to do.
//
// The limits and the treatment of texels are those of `cook render --environment`. Written from the formats'
// descriptions: G. Ward, "Real pixels" (Graphics Gems II) with Radiance's file formats, and "OpenEXR File Layout".
// OpenEXR's compression PIZ stands in piz.js.

'use strict';

(() => {
  const MAX_WIDTH = 16384;
  const MAX_HEIGHT = 8192;
  /** Pixels that any file may have. */
  const FREE_PIXELS = 1 << 20;
  /** Pixels that a larger map may have per byte of file; deflate reaches 125 of them. */
  const PIXELS_PER_BYTE = 128;
  /** More than any of OpenEXR's compressions reaches. */
  const BYTES_PER_BYTE = 1100;
  /** More than a chunk of the largest map needs, in bytes. */
  const MAX_CHUNK = 1 << 28;
  const gallery = (globalThis.gallery ??= {});
  const AGAIN = 'download or save it again';
  const ZIP = 'save it again as scan lines with ZIP compression';

  /** Why a file is not read; the message lacks the file's name. */
  class Refusal extends Error {}

  const refuse = (reason, remedy) => {
    throw new Refusal(`${reason}; ${remedy}`);
  };

  /** Reads a file from its start to its end, and refuses one that ends too soon. */
  class Reader {
    constructor(bytes) {
      this.bytes = bytes;
      this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
      this.at = 0;
    }

    take(count, what) {
      if (!(count >= 0 && count <= this.bytes.length - this.at)) refuse(`the file ends inside ${what}`, AGAIN);
      this.at += count;
      return this.bytes.subarray(this.at - count, this.at);
    }

    /** Where `count` bytes stand, which are passed over. */
    place(count, what) {
      this.take(count, what);
      return this.at - count;
    }

    u8(what) {
      return this.view.getUint8(this.place(1, what));
    }

    u32(what) {
      return this.view.getUint32(this.place(4, what), true);
    }

    i32(what) {
      return this.view.getInt32(this.place(4, what), true);
    }

    /** The characters before the next byte of a value, which is passed over. */
    until(end, what) {
      const length = this.bytes.subarray(this.at).indexOf(end);
      if (length < 0) refuse(`the file ends inside ${what}`, AGAIN);
      const text = new TextDecoder('latin1').decode(this.take(length, what));
      this.at += 1;
      return text;
    }
  }

  /** Part of a file's own text, for a message. */
  const quoted = (text) => `"${text.replace(/[^\x20-\x7e]/g, '?').slice(0, 40)}"`;

  function checkSize(width, height, fileBytes) {
    const bad = (rule, remedy) => refuse(`it states ${width} x ${height} pixels, but ${rule}`, remedy);
    if (width < 2 || height < 2) bad('it must have at least 2 x 2', 'give a latitude-longitude map');
    if (width > MAX_WIDTH || height > MAX_HEIGHT) bad(`at most ${MAX_WIDTH} x ${MAX_HEIGHT} are read`, 'scale it down');
    if (width * height > Math.max(FREE_PIXELS, fileBytes * PIXELS_PER_BYTE)) {
      bad(`its ${fileBytes} bytes cannot hold so many`, 'save it again or scale it down');
    }
  }

  /** Black texels of alpha 1. */
  function blackTexels(width, height) {
    let texels;
    try {
      texels = new Float32Array(4 * width * height);
    } catch {
      refuse(`this browser has no memory for ${width} x ${height} pixels`, 'scale it down');
    }
    for (let at = 3; at < texels.length; at += 4) texels[at] = 1;
    return texels;
  }

  /** Negative parts count as 0, as lossy compression leaves them; what is not finite is refused. */
  function checkTexels({ width, texels }) {
    for (let at = 0; at < texels.length; at++) {
      if (texels[at] < 0 && texels[at] !== -Infinity) texels[at] = 0;
      if (Number.isFinite(texels[at])) continue;
      const pixel = at >> 2;
      const place = `column ${pixel % width}, row ${Math.floor(pixel / width)} (from 0, top left)`;
      refuse(`the pixel in ${place} is ${texels[at]}, but radiance must be finite`, 'repair the pixel');
    }
  }

  /** Lets the page go on between parts of long work. */
  function breather() {
    let last = performance.now();
    return async () => {
      if (performance.now() - last < 40) return;
      await new Promise((resolve) => setTimeout(resolve, 0));
      last = performance.now();
    };
  }

  // Radiance.

  const DECIMAL = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i;

  /** The numbers of a header line, which must be so many. */
  function decimals(key, value, count) {
    const words = value.trim().split(/\s+/);
    if (words.length !== count || !words.every((word) => DECIMAL.test(word))) {
      refuse(`its header's ${key} is ${quoted(value.trim())}, and must be numbers, ${count} in all`, AGAIN);
    }
    return words.map((word) => Math.fround(Number(word)));
  }

  /** Reads the header up to the resolution: size, and what red, green and blue are to be divided by. */
  function radianceHeader(reader) {
    let [exposure, corrections] = [1, [1, 1, 1]];
    reader.until(10, 'its first line');
    for (let line = ' '; line !== ''; ) {
      line = reader.until(10, 'its header').replace(/\r$/, '');
      const [, key, value] = /^([^#=][^=]*)=(.*)$/s.exec(line) ?? [null, '', ''];
      if (key.trim() === 'FORMAT') checkRadianceFormat(value.trim());
      // All of a header multiply, and pixels are divided by the product.
      if (key.trim() === 'EXPOSURE') exposure = Math.fround(exposure * decimals('EXPOSURE', value, 1)[0]);
      if (key.trim() !== 'COLORCORR') continue;
      const factors = decimals('COLORCORR', value, 3);
      corrections = corrections.map((correction, part) => Math.fround(correction * factors[part]));
    }
    const divisors = corrections.map((correction) => Math.fround(exposure * correction));
    if (!divisors.every((divisor) => divisor >= 2 ** -126 && divisor < Infinity)) {
      refuse(`its exposures multiply to ${divisors.join(', ')}, but must be finite and above 0`, AGAIN);
    }
    const line = reader.until(10, 'its resolution').trim();
    const [, first, rows, second, columns] = /^([-+][XY])\s+(\d+)\s+([-+][XY])\s+(\d+)$/.exec(line) ?? [];
    if (!columns) refuse(`its resolution is ${quoted(line)}, not like "-Y 512 +X 1024"`, AGAIN);
    if (first !== '-Y' || second !== '+X') {
      refuse(`its pixels run ${first} ${second}, and only -Y +X is read`, 'save it again from the top left');
    }
    return { width: Number(columns), height: Number(rows), divisors };
  }

  function checkRadianceFormat(format) {
    if (format === '32-bit_rle_rgbe') return;
    const name = format === '32-bit_rle_xyze' ? 'XYZ (32-bit_rle_xyze)' : quoted(format);
    refuse(`its colours are ${name}, and only RGB (32-bit_rle_rgbe) is read`, 'save it again as RGBE');
  }

  /** Reads a row of four bytes a pixel into `row`. */
  function radianceRow(reader, row, width) {
    const first = reader.take(4, 'its pixels');
    const isNew = width >= 8 && width <= 32767 && first[0] === 2 && first[1] === 2 && first[2] < 128;
    if (!isNew) return oldRuns(reader, first, row, width);
    const stated = 256 * first[2] + first[3];
    if (stated !== width) refuse(`a row states ${stated} pixels, and the file ${width}`, AGAIN);
    for (let part = 0; part < 4; part++) newRuns(reader, row, part, width);
  }

  /** One component of all pixels: up to 128 bytes as they are, or a byte up to 127 times. */
  function newRuns(reader, row, part, width) {
    for (let x = 0; x < width; ) {
      const code = reader.u8('its pixels');
      const count = code > 128 ? code - 128 : code;
      if (count > width - x) refuse('a run of equal pixels does not fit in its row', AGAIN);
      const values = reader.take(code > 128 ? 1 : count, 'its pixels');
      for (let end = x + count, at = 0; x < end; x++, at++) row[4 * x + part] = values[code > 128 ? 0 : at];
    }
  }

  /** Pixels as they are, or (1, 1, 1, n) to repeat the last; such codes in sequence are digits of base 256. */
  function oldRuns(reader, first, row, width) {
    row.set(first);
    if (first[0] === 1 && first[1] === 1 && first[2] === 1) refuse('a row begins with a run', AGAIN);
    for (let x = 1, digit = 1; x < width; ) {
      const pixel = reader.take(4, 'its pixels');
      if (pixel[0] !== 1 || pixel[1] !== 1 || pixel[2] !== 1) {
        row.set(pixel, 4 * x++);
        digit = 1;
        continue;
      }
      const count = pixel[3] * digit;
      if (!(count <= width - x)) refuse('a run of equal pixels does not fit in its row', AGAIN);
      for (const end = x + count; x < end; x++) row.copyWithin(4 * x, 4 * x - 4, 4 * x);
      digit *= 256;
    }
  }

  async function radiance(bytes) {
    const reader = new Reader(bytes);
    const { width, height, divisors } = radianceHeader(reader);
    checkSize(width, height, bytes.length);
    const texels = blackTexels(width, height);
    const row = new Uint8Array(4 * width);
    const breathe = breather();
    for (let y = 0, to = 0; y < height; y++) {
      radianceRow(reader, row, width);
      for (let at = 0; at < row.length; at += 4, to += 4) {
        const scale = row[at + 3] === 0 ? 0 : 2 ** (row[at + 3] - 136);
        for (let part = 0; part < 3; part++) texels[to + part] = (row[at + part] * scale) / divisors[part];
      }
      await breathe();
    }
    return { width, height, texels };
  }

  // OpenEXR.

  /** By their numbers: name, and the number of lines in a chunk of those that are read. */
  const COMPRESSIONS = [
    { name: 'none', lines: 1, unpack: () => refuse('its pixels are not as many as stated', AGAIN) },
    { name: 'RLE', lines: 1, unpack: (packed, size) => recombined(runs(packed, size)) },
    { name: 'ZIPS', lines: 1, unpack: async (packed, size) => recombined(await inflated(packed, size)) },
    { name: 'ZIP', lines: 16, unpack: async (packed, size) => recombined(await inflated(packed, size)) },
    { name: 'PIZ', lines: 32, unpack: (packed, size, form) => gallery.unpackPiz(packed, size, form) },
    ...['PXR24', 'B44', 'B44A', 'DWAA', 'DWAB'].map((name) => ({ name })),
  ];

  const BYTES = [4, 2, 4];
  /** Reads a sample of type UINT, HALF or FLOAT. */
  const SAMPLE = [
    (view, at) => view.getUint32(at, true),
    (view, at) => halfTable[view.getUint16(at, true)],
    (view, at) => view.getFloat32(at, true),
  ];

  function half(bits) {
    const exponent = (bits >> 10) & 31;
    const mantissa = bits & 1023;
    const sign = bits >> 15 ? -1 : 1;
    if (exponent === 31) return mantissa ? NaN : sign * Infinity;
    return sign * (exponent ? (1024 + mantissa) * 2 ** (exponent - 25) : mantissa * 2 ** -24);
  }

  const halfTable = Float32Array.from({ length: 65536 }, (_, bits) => half(bits));

  /** Reads the header's attributes: type and contents by name. */
  function attributes(reader) {
    const found = new Map();
    for (;;) {
      const name = reader.until(0, 'its header');
      if (name === '') return found;
      const type = reader.until(0, 'its header');
      found.set(name, { type, contents: reader.take(reader.i32('its header'), 'its header') });
    }
  }

  /** A reader of an attribute's contents. */
  function attribute(found, name, type) {
    const { type: given, contents } = found.get(name) ?? {};
    if (given !== type) refuse(`its header has no ${name} of type ${type}`, AGAIN);
    return new Reader(contents);
  }

  function box(found, name) {
    const reader = attribute(found, name, 'box2i');
    const [left, top, right, bottom] = [0, 0, 0, 0].map(() => reader.i32(`its ${name}`));
    if (right < left || bottom < top) refuse(`its ${name} is empty`, AGAIN);
    return { left, top, width: right - left + 1, height: bottom - top + 1 };
  }

  /** Reads the list of channels: name, type, and the bytes of those before it per pixel of a row. */
  function channels(found) {
    const reader = attribute(found, 'channels', 'chlist');
    const list = [];
    let before = 0;
    for (let name; (name = reader.until(0, 'its channels')) !== ''; ) {
      const type = reader.u32('its channels');
      reader.take(4, 'its channels');
      const steps = [reader.i32('its channels'), reader.i32('its channels')];
      if (!(type in BYTES)) refuse(`its channel ${quoted(name)} is of unknown type ${type}`, AGAIN);
      if (steps[0] !== 1 || steps[1] !== 1) {
        refuse(`its channel ${quoted(name)} lacks pixels (luminance and chroma)`, 'save it again as RGB');
      }
      list.push({ name, type, bytes: BYTES[type], before });
      before += BYTES[type];
    }
    return { list, pixelBytes: before };
  }

  /** The channels that red, green and blue are read from. */
  function colours(list) {
    const named = (name) => list.find((channel) => channel.name === name);
    const rgb = ['R', 'G', 'B'].map(named);
    if (rgb.every(Boolean)) return rgb;
    if (named('Y') && !named('RY')) return [named('Y'), named('Y'), named('Y')];
    const layer = list.find(({ name }) => /\.[RGBY]$/i.test(name))?.name.replace(/\.[^.]*$/, '');
    if (layer) refuse(`its colours are in the layer ${quoted(layer)}`, 'save that layer alone, as R, G and B');
    const names = list.slice(0, 8).map(({ name }) => name).join(', ');
    refuse(`its channels are ${quoted(names)}, not R, G and B or Y`, 'save it again as RGB');
  }

  function checkVersion(version) {
    if ((version & 255) !== 2) refuse(`it is OpenEXR of version ${version & 255}, and only 2 is read`, ZIP);
    const kinds = [[0x800, 'deep data'], [0x1000, 'several parts'], [0x200, 'tiles']];
    for (const [flag, kind] of kinds) if (version & flag) refuse(`it is OpenEXR with ${kind}, which is not read`, ZIP);
    if ((version & ~0x4ff) !== 0) refuse('it is OpenEXR of an unknown kind', ZIP);
  }

  async function openExr(bytes) {
    const reader = new Reader(bytes);
    reader.take(4, 'its header');
    checkVersion(reader.u32('its header'));
    const found = attributes(reader);
    const number = attribute(found, 'compression', 'compression').u8('its compression');
    const { name, lines, unpack } = COMPRESSIONS[number] ?? { name: `number ${number}` };
    if (!unpack) refuse(`its compression is ${name}, which is not read`, ZIP);
    const { list, pixelBytes } = channels(found);
    const parts = colours(list);
    const [data, display] = [box(found, 'dataWindow'), box(found, 'displayWindow')];
    checkSize(display.width, display.height, bytes.length);
    const picture = { ...display, texels: blackTexels(display.width, display.height) };
    const chunks = Math.ceil(data.height / lines);
    // The chunks follow each other; where they start is not needed.
    reader.take(8 * chunks, 'its table of chunks');
    const seen = new Set();
    const breathe = breather();
    for (let count = 0; count < chunks; count++) {
      const row = reader.i32('its pixels') - data.top;
      const isNew = row >= 0 && row < data.height && row % lines === 0 && !seen.has(row);
      if (!isNew) refuse('its chunks are mixed up', AGAIN);
      seen.add(row);
      const packed = reader.take(reader.i32('its pixels'), 'its pixels');
      const form = { width: data.width, height: Math.min(lines, data.height - row), list, pixelBytes };
      const samples = await unpacked(packed, form, unpack);
      copyRows(samples, { ...form, left: data.left, top: data.top + row, parts }, picture);
      await breathe();
    }
    return { width: display.width, height: display.height, texels: picture.texels };
  }

  /** Decompresses a chunk; what would not get smaller stands in the file as it is. */
  async function unpacked(packed, form, unpack) {
    const size = form.width * form.height * form.pixelBytes;
    if (packed.length > size || size > packed.length * BYTES_PER_BYTE + 1024 || size > MAX_CHUNK) {
      refuse(`${packed.length} bytes of its pixels cannot be ${size} uncompressed`, AGAIN);
    }
    if (packed.length === size) return packed;
    try {
      return await unpack(packed, size, form);
    } catch {
      return refuse('its compressed pixels are damaged', AGAIN);
    }
  }

  /** Copies a chunk's rows to where they stand in the picture; what lies outside is dropped. */
  function copyRows(samples, rows, picture) {
    const view = new DataView(samples.buffer, samples.byteOffset, samples.byteLength);
    const shift = rows.left - picture.left;
    const from = Math.max(0, -shift);
    const to = Math.min(rows.width, picture.width - shift);
    for (let row = 0; row < rows.height; row++) {
      const y = rows.top + row - picture.top;
      if (y < 0 || y >= picture.height) continue;
      rows.parts.forEach(({ type, bytes, before }, part) => {
        const sample = SAMPLE[type];
        const start = rows.width * (row * rows.pixelBytes + before);
        const target = 4 * (y * picture.width + shift) + part;
        for (let x = from; x < to; x++) picture.texels[target + 4 * x] = sample(view, start + x * bytes);
      });
    }
  }

  /** Inflates to exactly `size` bytes, and stops at the first more. */
  async function inflated(packed, size) {
    const bytes = new Uint8Array(size);
    const reader = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate')).getReader();
    let filled = 0;
    for (let part; !(part = await reader.read()).done; filled += part.value.length) {
      if (part.value.length > size - filled) {
        reader.cancel().catch(() => {});
        throw new RangeError('more bytes than stated');
      }
      bytes.set(part.value, filled);
    }
    if (filled !== size) throw new RangeError('fewer bytes than stated');
    return bytes;
  }

  /** OpenEXR's run lengths: -n, then n bytes as they are, or n, then a byte that stands n + 1 times. */
  function runs(packed, size) {
    const reader = new Reader(packed);
    const bytes = new Uint8Array(size);
    for (let filled = 0; filled < size; ) {
      const code = (reader.u8('a run') << 24) >> 24;
      const count = code < 0 ? -code : code + 1;
      if (count > size - filled) throw new RangeError('more bytes than stated');
      if (code < 0) bytes.set(reader.take(count, 'a run'), filled);
      else bytes.fill(reader.u8('a run'), filled, filled + count);
      filled += count;
    }
    return bytes;
  }

  /** Sums differences of bytes, and interleaves the two halves. */
  function recombined(bytes) {
    for (let at = 1; at < bytes.length; at++) bytes[at] = bytes[at - 1] + bytes[at] - 128;
    const whole = new Uint8Array(bytes.length);
    const middle = Math.ceil(bytes.length / 2);
    for (let at = 0; at < bytes.length; at++) whole[at] = bytes[(at >> 1) + (at & 1 ? middle : 0)];
    return whole;
  }

  /** Decodes a file; see above. */
  async function decodeEnvironment(arrayBuffer, fileName) {
    const name = String(fileName).replace(/[\x00-\x1f\x7f]/g, ' ').slice(0, 200);
    try {
      const bytes = new Uint8Array(arrayBuffer);
      const starts = (...start) => start.every((byte, at) => bytes[at] === byte);
      let picture;
      if (starts(0x23, 0x3f)) picture = await radiance(bytes);
      else if (starts(0x76, 0x2f, 0x31, 0x01)) picture = await openExr(bytes);
      else refuse('this is no Radiance .hdr or OpenEXR .exr picture', 'give one, since others hold no radiance');
      checkTexels(picture);
      return picture;
    } catch (error) {
      const isKnown = error instanceof Refusal;
      throw new Error(`${name}: ${isKnown ? error.message : `it cannot be decoded (${error}); ${AGAIN}`}`);
    }
  }

  gallery.decodeEnvironment = decodeEnvironment;
})();
