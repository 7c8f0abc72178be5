// Writes .hdr and .exr files for tests, sound and unsound.

import { deflateSync } from 'node:zlib';

/** A Radiance picture: header lines, resolution, and bytes of pixels. */
export function hdr(pixels, { first = '#?RADIANCE', lines = 'FORMAT=32-bit_rle_rgbe\n', size = '-Y 2 +X 8' } = {}) {
  return Buffer.concat([Buffer.from(`${first}\n${lines}\n${size}\n`, 'latin1'), Buffer.from(pixels)]);
}

/** Sixteen pixels of (1, .5, .25) as they are. */
export const FLAT = Array.from({ length: 64 }, (_, at) => [128, 64, 32, 129][at % 4]);

const i32 = (...values) => {
  const bytes = Buffer.alloc(4 * values.length);
  values.forEach((value, at) => bytes.writeInt32LE(value | 0, 4 * at));
  return bytes;
};
const text = (value) => Buffer.from(`${value}\0`, 'latin1');

export const attribute = (name, type, contents, size = contents.length) =>
  Buffer.concat([text(name), text(type), i32(size), contents]);

/** A list of channels: name, type, and steps in x and y. */
export const chlist = (rows) =>
  Buffer.concat([...rows.flatMap(([name, type = 1, x = 1, y = 1]) => [text(name), i32(type, 0, x, y)]), text('')]);

/** A predictor's differences of the two interleaved halves: what ZIP deflates. */
export function predicted(bytes) {
  const halves = [...bytes.filter((_, at) => at % 2 === 0), ...bytes.filter((_, at) => at % 2 === 1)];
  return Uint8Array.from(halves, (byte, at) => (at === 0 ? byte : byte - halves[at - 1] + 128));
}

export const zipped = (bytes) => deflateSync(predicted(bytes));

/** Half floats of RGB, all 1, for one row of eight pixels. */
export const ROW = Uint8Array.from({ length: 48 }, (_, at) => (at % 2 ? 0x3c : 0));

/** An OpenEXR picture of 8 x 2 pixels, any part of which can be given otherwise. */
export function exr(given = {}) {
  const parts = {
    version: 2,
    channels: attribute('channels', 'chlist', chlist([['B'], ['G'], ['R']])),
    compression: attribute('compression', 'compression', Buffer.of(0)),
    dataWindow: attribute('dataWindow', 'box2i', i32(0, 0, 7, 1)),
    displayWindow: attribute('displayWindow', 'box2i', i32(0, 0, 7, 1)),
    lineOrder: attribute('lineOrder', 'lineOrder', Buffer.of(0)),
    end: text(''),
    rows: [{ y: 0, bytes: ROW }, { y: 1, bytes: ROW }],
    ...given,
  };
  const table = Buffer.alloc(8 * (parts.table ?? parts.rows.length));
  const chunks = parts.rows.map(({ y, bytes, size = bytes.length }) => Buffer.concat([i32(y, size), bytes]));
  const names = ['channels', 'compression', 'dataWindow', 'displayWindow', 'lineOrder', 'end'];
  const header = names.map((name) => parts[name]);
  return Buffer.concat([i32(20000630, parts.version), ...header, table, ...chunks]);
}

export const windowOf = (name, ...sides) => ({ [name]: attribute(name, 'box2i', i32(...sides)) });
export const compression = (number) => ({ compression: attribute('compression', 'compression', Buffer.of(number)) });
export const channels = (...rows) => ({ channels: attribute('channels', 'chlist', chlist(rows)) });
