// Decompresses OpenEXR's PIZ for environment.js: the 16-bit values that occur are numbered, and Haar wavelets of the
// numbers are Huffman-coded. Written from "OpenEXR File Layout" and the description of its compression schemes.

'use strict';

(() => {
  const damaged = () => {
    throw new RangeError('damaged');
  };

  /** `count` bytes from a place, all of which must be there. */
  function part(bytes, from, count) {
    if (!(count <= bytes.length - from)) damaged();
    return bytes.subarray(from, from + count);
  }

  /**
   * Decompresses a chunk to `size` bytes: rows of `width` samples of each channel in `list`, of 2 or 4 bytes each.
   * Throws a RangeError if the chunk is damaged.
   */
  function unpackPiz(packed, size, { width, height, list }) {
    const source = new DataView(packed.buffer, packed.byteOffset, packed.byteLength);
    const [first, last] = [source.getUint16(0, true), source.getUint16(2, true)];
    const bitmap = first <= last ? last - first + 1 : 0;
    const [values, largest] = occurring(part(packed, 4, bitmap), first);
    const words = huffman(part(packed, 8 + bitmap, source.getUint32(4 + bitmap, true)), size / 2);
    // The channels one after another, and of each a plane of 16-bit words, two of which are a 32-bit sample.
    for (let place = 0, channel = 0; channel < list.length; channel++) {
      const step = list[channel].bytes / 2;
      for (let word = 0; word < step; word++) unwavelet(words, place + word, width, height, step, largest);
      place += width * height * step;
    }
    const bytes = new Uint8Array(size);
    const target = new DataView(bytes.buffer);
    for (let to = 0, row = 0; row < height; row++) {
      for (let place = 0, channel = 0; channel < list.length; channel++) {
        const count = (width * list[channel].bytes) / 2;
        const start = place + row * count;
        for (let at = 0; at < count; at++, to += 2) target.setUint16(to, values[words[start + at]], true);
        place += count * height;
      }
    }
    return bytes;
  }

  /** The values whose bits are set, and 0: by number, and the largest number. `first` is the bitmap's place. */
  function occurring(bitmap, first) {
    const bits = new Uint8Array(8192);
    bits.set(bitmap, first);
    const values = new Uint16Array(65536);
    let count = 1;
    for (let value = 1; value < 65536; value++) if ((bits[value >> 3] >> (value & 7)) & 1) values[count++] = value;
    return [values, count - 1];
  }

  /** Reads the codes' lengths, 6 bits a symbol; 59 to 62 are 2 to 5 zeros, and 63 at least 6. Also where they end. */
  function codeLengths(packed, first, last) {
    const lengths = new Uint8Array(65537);
    let bit = 0;
    const bits = (count) => {
      let value = 0;
      for (const end = bit + count; bit < end; bit++) value = 2 * value + ((packed[bit >> 3] >> (~bit & 7)) & 1);
      return value;
    };
    for (let symbol = first; symbol <= last; ) {
      const length = bits(6);
      if (length < 59) lengths[symbol++] = length;
      else symbol += length === 63 ? bits(8) + 6 : length - 57;
      if (symbol > last + 1) damaged();
    }
    return [lengths, Math.ceil(bit / 8)];
  }

  /**
   * Canonical codes: of one length they follow each other, in the order of their symbols, and above those that start
   * longer codes. For each length the first code, the number of codes, and where their symbols start.
   */
  function canonicalCodes(lengths) {
    const [counts, firsts, starts] = [0, 0, 0].map(() => new Int32Array(59));
    for (const length of lengths) counts[length]++;
    for (let length = 58, first = 0; length > 0; length--) {
      firsts[length] = first;
      first = (first + counts[length]) >> 1;
    }
    for (let length = 1; length < 58; length++) starts[length + 1] = starts[length] + counts[length];
    const symbols = new Int32Array(lengths.length);
    const next = Int32Array.from(starts);
    lengths.forEach((length, symbol) => length > 0 && (symbols[next[length]++] = symbol));
    return { counts, firsts, starts, symbols };
  }

  /** Decodes exactly `size` words. */
  function huffman(packed, size) {
    const view = new DataView(packed.buffer, packed.byteOffset, packed.byteLength);
    const [first, last, bits] = [0, 4, 12].map((at) => view.getUint32(at, true));
    if (first > last || last > 65536) damaged();
    const table = packed.subarray(20);
    const [lengths, end] = codeLengths(table, first, last);
    const { counts, firsts, starts, symbols } = canonicalCodes(lengths);
    const codes = part(table, end, Math.ceil(bits / 8));
    const words = new Uint16Array(size);
    let [filled, code, length] = [0, 0, 0];
    for (let bit = 0; bit < bits; bit++) {
      code = 2 * code + ((codes[bit >> 3] >> (~bit & 7)) & 1);
      if (++length > 58) damaged();
      if (code < firsts[length]) continue;
      const place = code - firsts[length];
      if (place >= counts[length]) damaged();
      const symbol = symbols[starts[length] + place];
      [code, length] = [0, 0];
      let count = 1;
      // The last symbol is a run of the word before it, whose length follows in 8 bits.
      if (symbol === last) {
        if (filled === 0 || bit + 8 >= bits) damaged();
        const both = (codes[(bit + 1) >> 3] << 8) | codes[(bit + 8) >> 3];
        count = (both >> (~bit - 8 & 7)) & 255;
        bit += 8;
      }
      if (count > size - filled) damaged();
      if (symbol === last) words.fill(words[filled - 1], filled, filled + count);
      else words[filled] = symbol;
      filled += count;
    }
    if (filled !== size || length !== 0) damaged();
    return words;
  }

  /** Undoes the wavelet transform of a plane whose words stand `step` apart, from the coarsest level to the finest. */
  function unwavelet(words, start, width, height, step, largest) {
    const pair = largest < 1 << 14 ? signedPair : wrappedPair;
    const line = width * step;
    for (let reach = 2 ** Math.floor(Math.log2(Math.min(width, height))) / 2; reach >= 1; reach /= 2) {
      const [right, down] = [reach * step, reach * line];
      let y = 0;
      for (; y + 2 * reach <= height; y += 2 * reach) {
        let x = 0;
        for (; x + 2 * reach <= width; x += 2 * reach) {
          const at = start + y * line + x * step;
          pair(words, at, at + down);
          pair(words, at + right, at + right + down);
          pair(words, at, at + right);
          pair(words, at + down, at + down + right);
        }
        if (width & reach) pair(words, start + y * line + x * step, start + y * line + x * step + down);
      }
      if (!(height & reach)) continue;
      for (let x = 0; x + 2 * reach <= width; x += 2 * reach) {
        pair(words, start + y * line + x * step, start + y * line + x * step + right);
      }
    }
  }

  /** A pair from its mean and difference, where no more than 14 bits are used. */
  function signedPair(words, low, high) {
    const difference = (words[high] << 16) >> 16;
    const first = ((words[low] << 16) >> 16) + (difference & 1) + (difference >> 1);
    words[low] = first;
    words[high] = first - difference;
  }

  /** A pair from its mean and difference modulo 2^16. */
  function wrappedPair(words, low, high) {
    const second = words[low] - (words[high] >> 1);
    words[low] = words[high] + second - 32768;
    words[high] = second;
  }

  (globalThis.gallery ??= {}).unpackPiz = unpackPiz;
})();
