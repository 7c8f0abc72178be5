// node --test: environment.js reads what it says it reads, and refuses everything else in one sentence.

import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import test from 'node:test';
import { deflateSync } from 'node:zlib';
import { decodeEnvironment } from './scripts.mjs';
import { FLAT, ROW, attribute, channels, chlist, compression, exr, hdr, windowOf, zipped } from './write.mjs';

const FILES = new URL('files/', import.meta.url);
const file = (name) => readFileSync(new URL(name, FILES));

/** Reads bytes as a page gets them. */
const decode = (bytes, name = 'sky') =>
  decodeEnvironment(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), name);

/** A sample of make.py's channels. */
function sample(x, y, part, kind) {
  const whole = Math.floor(((x * (part + 1) + y * y) % 37) / 5) + part;
  return Math.fround(whole / { half: 8, float: 3, uint: 1 }[kind]);
}

function check({ width, height, texels }, size, expected) {
  assert.deepEqual([width, height], size);
  assert.equal(texels.length, 4 * width * height);
  for (let at = 0; at < texels.length; at++) {
    const [x, y, part] = [(at >> 2) % width, Math.floor(at / 4 / width), at & 3];
    const value = part === 3 ? 1 : expected(x, y, part);
    assert.equal(texels[at], value, `column ${x}, row ${y}, part ${part}`);
  }
}

const plain = (kind) => (x, y, part) => sample(x, y, part, kind);

for (const name of ['none', 'rle', 'zips', 'zip', 'piz']) {
  for (const kind of ['half', 'float', 'uint']) {
    test(`OpenEXR, ${name}, ${kind}`, async () => {
      const size = name === 'none' ? [10, 8] : kind === 'half' ? [11, 61] : [7, 35];
      check(await decode(file(`${name}_${kind}.exr`)), size, plain(kind));
    });
  }
}

test('OpenEXR: luminance, further channels, rows from below', async () => {
  check(await decode(file('luminance.exr')), [6, 4], (x, y) => sample(x, y, 0, 'half'));
  check(await decode(file('alpha_and_depth.exr')), [6, 4], plain('half'));
  check(await decode(file('decreasing.exr')), [6, 9], plain('half'));
});

test('OpenEXR: the picture is the display window, black where there are no data', async () => {
  const inside = (x, y) => x >= -2 && x <= 7 && y >= 1 && y <= 9;
  const expected = (x, y, part) => (inside(x, y) ? sample(x + 2, y - 1, part, 'half') : 0);
  check(await decode(file('windows.exr')), [6, 12], expected);
});

test('OpenEXR: half floats', async () => {
  const bits = [0x0000, 0x0001, 0x03ff, 0x0400, 0x3c00, 0x7bff, 0x8000, 0xc000];
  const values = [0, 2 ** -24, 1023 * 2 ** -24, 2 ** -14, 1, 65504, 0, 0];
  const row = new Uint8Array(Uint16Array.from([...bits, ...bits, ...bits]).buffer);
  const { texels } = await decode(exr({ rows: [{ y: 0, bytes: row }, { y: 1, bytes: row }] }));
  values.forEach((value, x) => assert.equal(texels[4 * x] + 0, value));
});

test('OpenEXR: ZIP in one chunk, stored smaller or as it is', async () => {
  const both = Uint8Array.of(...ROW, ...ROW);
  for (const bytes of [zipped(both), both]) {
    check(await decode(exr({ ...compression(3), rows: [{ y: 0, bytes }] })), [8, 2], () => 1);
  }
});

const NEW = (width) => [2, 2, width >> 8, width & 255];

test('Radiance: as they are, old runs, new runs', async () => {
  const values = [1, 0.5, 0.25];
  const expected = (x, y, part) => values[part];
  check(await decode(hdr(FLAT)), [8, 2], expected);
  const pixel = FLAT.slice(0, 4);
  const old = [...pixel, 1, 1, 1, 4, ...pixel, 1, 1, 1, 2];
  check(await decode(hdr([...old, ...old])), [8, 2], expected);
  const row = [...NEW(8), 136, 128, 8, ...Array(8).fill(64), 131, 32, 5, ...Array(5).fill(32), 136, 129];
  check(await decode(hdr([...row, ...row])), [8, 2], expected);
  // Runs of 3 + 1 * 256 pixels, and rows too short for new runs.
  const wide = [...pixel, 1, 1, 1, 3, 1, 1, 1, 1];
  check(await decode(hdr([...wide, ...wide], { size: '-Y 2 +X 260' })), [260, 2], expected);
  const narrow = [2, 2, 0, 129, ...pixel];
  const { texels } = await decode(hdr([...narrow, ...narrow], { size: '-Y 2 +X 2' }));
  assert.deepEqual([...texels.slice(0, 8)], [2 / 128, 2 / 128, 0, 1, 1, 0.5, 0.25, 1]);
  const dark = hdr(FLAT.map((byte, at) => (at % 4 === 3 ? 0 : byte)));
  check(await decode(dark), [8, 2], () => 0);
});

test('Radiance: headers of any program, divided by exposures', async () => {
  const first = async (options) => [...(await decode(hdr(FLAT, options))).texels.slice(0, 3)];
  for (const name of ['#?RADIANCE', '#?RGBE', '#?AUTOPANO 1']) {
    assert.deepEqual(await first({ first: name }), [1, 0.5, 0.25]);
  }
  for (const [lines, expected] of [
    ['', [1, 0.5, 0.25]],
    ['# EXPOSURE=9\nSOFTWARE=x=y\noconv a b\n\tVIEW= -vtv\n', [1, 0.5, 0.25]],
    ['EXPOSURE=4\n', [0.25, 0.125, 0.0625]],
    ['EXPOSURE=0.5\n# a comment\nEXPOSURE= 4.0\n', [0.5, 0.25, 0.125]],
    ['EXPOSURE=2\nCOLORCORR=1 0.5 0.25\n', [0.5, 0.5, 0.5]],
    [' EXPOSURE =4e0\r\n', [0.25, 0.125, 0.0625]],
  ]) {
    assert.deepEqual(await first({ lines }), expected, lines);
  }
});

const stated = (size) => hdr([], { size });
const samples = (...bytes) => exr({ rows: [{ y: 0, bytes: Uint8Array.from(bytes) }, { y: 1, bytes: ROW }] });
const ofBits = (at, bits) => {
  const row = ROW.slice();
  row.set([bits & 255, bits >> 8], at);
  return exr({ rows: [{ y: 0, bytes: ROW }, { y: 1, bytes: row }] });
};
/** One chunk, compressed by the method of a number. */
const one = (number, bytes, more = {}) => exr({ ...compression(number), ...more, rows: [{ y: 0, bytes }] });
const zip = (bytes, more) => one(3, bytes, more);
const NONE = Buffer.alloc(0);
const large = { ...windowOf('dataWindow', 0, 0, 1023, 15), ...windowOf('displayWindow', 0, 0, 1023, 15) };
/** A chunk of PIZ: no values but 0, and a code table of the given bytes. */
const piz = (table, bits = 0, [first, last] = [0, 1], length = 20 + table.length) => {
  const head = Uint32Array.of(length, first, last, 0, bits, 0);
  const bytes = Uint8Array.of(255, 31, 0, 0, ...new Uint8Array(head.buffer), ...table);
  return one(4, bytes);
};

/** Files that are refused, and a word of why. */
const REFUSED = {
  'an empty file': [NONE, /no Radiance .hdr or OpenEXR/],
  'a text': [Buffer.from('hello'), /no Radiance/],
  'a PNG picture': [Buffer.from('\x89PNG\r\n\x1a\n0000', 'latin1'), /no Radiance/],
  'Radiance cut after its mark': [Buffer.from('#?'), /ends inside its first line/],
  'Radiance without an end of header': [Buffer.from('#?RGBE\nA=1\n'), /ends inside its header/],
  'Radiance without resolution': [Buffer.from('#?RGBE\n\n-Y 2 +X'), /ends inside its resolution/],
  'XYZE': [hdr(FLAT, { lines: 'FORMAT=32-bit_rle_xyze\n' }), /XYZ .*save it again as RGBE/],
  'an unknown format': [hdr(FLAT, { lines: 'FORMAT=\x07<b>\n' }), /"\?<b>"/],
  'a broken resolution': [hdr(FLAT, { size: 'Y 2 X 8' }), /"Y 2 X 8"/],
  'a turned picture': [hdr(FLAT, { size: '+X 8 -Y 2' }), /run \+X -Y/],
  'a mirrored picture': [hdr(FLAT, { size: '-Y 2 -X 8' }), /run -Y -X/],
  'an exposure of 0': [hdr(FLAT, { lines: 'EXPOSURE=0\n' }), /above 0/],
  'a negative exposure': [hdr(FLAT, { lines: 'EXPOSURE=-1\n' }), /above 0/],
  'an exposure without end': [hdr(FLAT, { lines: 'EXPOSURE=1e39\n' }), /above 0/],
  'an exposure that is a word': [hdr(FLAT, { lines: 'EXPOSURE=nan\n' }), /EXPOSURE is "nan"/],
  'two numbers for three': [hdr(FLAT, { lines: 'COLORCORR=1 1\n' }), /COLORCORR/],
  'radiance beyond floats': [hdr(FLAT.map(() => 255), { lines: 'EXPOSURE=1e-30\n' }), /column 0, row 0 .* Infinity/],
  'small with a large claim': [stated('-Y 8192 +X 16384'), /cannot hold so many/],
  'too high': [stated('-Y 8193 +X 16'), /at most 16384 x 8192/],
  'too wide': [stated('-Y 16 +X 16385'), /at most 16384 x 8192/],
  'far too large': [stated(`-Y ${'9'.repeat(400)} +X ${'9'.repeat(30)}`), /at most/],
  'one row': [stated('-Y 1 +X 16'), /at least 2 x 2/],
  'no pixels': [stated('-Y 0 +X 0'), /at least 2 x 2/],
  'a row of another width': [hdr([...NEW(9), ...FLAT]), /a row states 9 pixels/],
  'a run over the end of its row': [hdr([...NEW(8), 137, 1]), /does not fit/],
  'bytes over the end of their row': [hdr([...NEW(8), 9, ...FLAT]), /does not fit/],
  'an old run at the start': [hdr([1, 1, 1, 3, ...FLAT]), /begins with a run/],
  'an old run over the end': [hdr([...FLAT.slice(0, 4), 1, 1, 1, 8, ...FLAT]), /does not fit/],
  'old runs of nothing, to the end': [hdr([...FLAT.slice(0, 4), ...Array(4000).fill([1, 1, 1, 0]).flat()]), /ends|fit/],
  'OpenEXR of another version': [exr({ version: 3 }), /version 3/],
  'tiles': [file('tiles.exr'), /tiles.*ZIP compression/],
  'parts': [file('parts.exr'), /several parts.*ZIP compression/],
  'deep data': [exr({ version: 0x802 }), /deep data.*ZIP compression/],
  'an unknown flag': [exr({ version: 0x8002 }), /unknown kind/],
  'PXR24': [file('pxr24.exr'), /PXR24.*ZIP compression/],
  'B44': [file('b44.exr'), /B44.*ZIP compression/],
  'B44A': [exr(compression(7)), /B44A/],
  'DWAA': [file('dwaa.exr'), /DWAA.*ZIP compression/],
  'DWAB': [exr(compression(9)), /DWAB/],
  'a compression of the future': [exr(compression(77)), /number 77/],
  'no compression attribute': [exr({ compression: NONE }), /no compression/],
  'an empty compression attribute': [exr({ compression: attribute('compression', 'compression', NONE) }), /ends/],
  'no channels attribute': [exr({ channels: NONE }), /no channels of type chlist/],
  'channels of another type': [exr({ channels: attribute('channels', 'string', chlist([['R']])) }), /no channels/],
  'no channels': [exr(channels()), /not R, G and B or Y/],
  'a list of channels without end': [
    exr({ channels: attribute('channels', 'chlist', chlist([['B'], ['G'], ['R']]).subarray(0, 40)) }),
    /ends inside its channels/,
  ],
  'a layer': [file('layer.exr'), /layer "diffuse"/],
  'depth alone': [file('depth_alone.exr'), /"Z", not R, G and B or Y/],
  'luminance and chroma': [exr(channels(['BY', 1, 2, 2], ['RY', 1, 2, 2], ['Y'])), /luminance and chroma/],
  'a step of 0': [exr(channels(['B', 1, 0, 1], ['G'], ['R'])), /lacks pixels/],
  'an unknown type of sample': [exr(channels(['B', 3], ['G'], ['R'])), /unknown type 3/],
  'no data window': [exr({ dataWindow: NONE }), /no dataWindow/],
  'a short window': [exr({ dataWindow: attribute('dataWindow', 'box2i', Buffer.alloc(15)) }), /inside its dataWindow/],
  'an empty window': [exr(windowOf('dataWindow', 3, 0, 2, 1)), /dataWindow is empty/],
  'a display of all integers': [exr(windowOf('displayWindow', -(2 ** 31), 0, 2 ** 31 - 1, 1)), /4294967296 x 2/],
  'data of all integers': [exr(windowOf('dataWindow', -(2 ** 31), 0, 2 ** 31 - 1, 1)), /cannot be/],
  'rows of all integers': [exr(windowOf('dataWindow', 0, -(2 ** 31), 7, 2 ** 31 - 1)), /ends inside its table/],
  'a small display with a large claim': [exr(windowOf('displayWindow', 0, 0, 16383, 8191)), /cannot hold so many/],
  'one display row': [exr(windowOf('displayWindow', 0, 0, 7, 0)), /at least 2 x 2/],
  'an attribute of negative size': [exr({ lineOrder: attribute('x', 'y', NONE, -1) }), /ends inside its header/],
  'an attribute larger than the file': [exr({ lineOrder: attribute('x', 'y', NONE, 2 ** 31 - 1) }), /inside its/],
  'no end of header': [exr({ end: NONE, rows: [], table: 0 }), /ends inside its header/],
  'a row twice': [exr({ rows: [{ y: 0, bytes: ROW }, { y: 0, bytes: ROW }] }), /mixed up/],
  'a row beyond': [exr({ rows: [{ y: 0, bytes: ROW }, { y: 2, bytes: ROW }] }), /mixed up/],
  'a row before': [exr({ rows: [{ y: -1, bytes: ROW }, { y: 1, bytes: ROW }] }), /mixed up/],
  'a chunk of negative size': [exr({ rows: [{ y: 0, bytes: ROW, size: -5 }], table: 2 }), /ends inside its pixels/],
  'too few samples': [samples(...ROW.slice(1)), /not as many|damaged/],
  'too many samples': [samples(...ROW, 0), /cannot be 48/],
  'NaN': [ofBits(34, 0x7e00), /column 1, row 1 .* NaN/],
  'infinity': [ofBits(0, 0x7c00), /column 0, row 1 .* Infinity/],
  'negative infinity': [ofBits(18, 0xfc00), /column 1, row 1 .* -Infinity/],
  'ZIP of nothing': [zip(NONE), /damaged/],
  'ZIP of noise': [zip(Uint8Array.of(1, 2, 3, 4, 5, 6)), /damaged/],
  'ZIP of too little': [zip(zipped(ROW)), /damaged/],
  'ZIP cut': [zip(zipped(Uint8Array.of(...ROW, ...ROW)).subarray(0, -6)), /damaged/],
  'a bomb': [zip(deflateSync(Buffer.alloc(40 << 20)), large), /damaged/],
  'a chunk beyond deflate': [zip(Uint8Array.of(1, 2, 3), large), /cannot be 98304/],
  'RLE over the end': [one(1, Uint8Array.of(127, 0), { table: 2 }), /damaged/],
  'RLE cut': [one(1, Uint8Array.of(128, 1), { table: 2 }), /damaged/],
  'PIZ of nothing': [one(4, NONE), /damaged/],
  'PIZ without codes': [piz([0, 0]), /damaged/],
  'PIZ with a wrong table': [piz([255, 255, 255]), /damaged/],
  'PIZ with symbols beyond': [piz([0, 0], 0, [0, 70000]), /damaged/],
  'PIZ with symbols reversed': [piz([0, 0], 0, [5, 1]), /damaged/],
  'PIZ with more bits than bytes': [piz([4, 16], 4e9), /damaged/],
  'PIZ that begins with a run': [piz([4, 16, 255, 255], 16), /damaged/],
  'PIZ of another length': [piz([4, 16], 0, [0, 1], 4e9), /damaged/],
};

/** The message of a refusal, one sentence that names the file. */
async function refusal(bytes, name = 'a <sky>.exr') {
  const error = await decode(bytes, name).then(
    ({ width, height }) => assert.fail(`it was read, ${width} x ${height}`),
    (error) => error,
  );
  checkRefusal(error, name);
  return error.message.slice(name.length + 2);
}

function checkRefusal(error, name) {
  assert.equal(error.constructor, Error, String(error.stack));
  assert.ok(error.message.startsWith(`${name}: `), error.message);
  assert.match(error.message.slice(name.length), /^: [^\n]+; [^\n;]+$/);
  assert.doesNotMatch(error.message, /cannot be decoded/);
}

for (const [name, [bytes, words]] of Object.entries(REFUSED)) {
  test(`refused: ${name}`, async () => assert.match(await refusal(bytes), words));
}

test('refused: names with line feeds are written in one line', async () => {
  await assert.rejects(decode(Buffer.from('x'), 'a\nb'), { message: /^a b: / });
});

test('refused: every sound file, cut anywhere', async () => {
  const cuts = ['windows.exr', 'luminance.exr', 'none_half.exr', 'piz_uint.exr'].map(file);
  const sound = [...cuts, exr(), hdr(FLAT, { lines: 'EXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n' })];
  for (const bytes of sound) {
    await decode(bytes);
    for (let end = 0; end < bytes.length; end++) await refusal(bytes.subarray(0, end));
  }
});

/** Pseudorandom numbers below a limit: xorshift of 32 bits. */
function numbers(seed) {
  let state = seed;
  return (limit) => {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    return (state >>> 0) % limit;
  };
}

test('2000 changed files are refused, or pictures of radiance', async () => {
  const below = numbers(20210621);
  const row = [...NEW(8), 136, 128, 8, ...Array(8).fill(64), 131, 32, 5, ...Array(5).fill(32), 136, 129];
  const names = readdirSync(FILES).filter((name) => name.endsWith('.exr'));
  const sound = [...names.map(file), hdr(FLAT), hdr([...row, ...row]), exr()];
  let read = 0;
  for (let round = 0; round < 2000; round++) {
    const bytes = Buffer.from(sound[round % sound.length]);
    for (let count = 1 + below(4); count > 0; count--) {
      const at = below(bytes.length);
      bytes[at] = [bytes[at] ^ (1 << below(8)), below(256), 0, 255][below(4)];
    }
    try {
      const { width, height, texels } = await decode(bytes, 'sky');
      read += 1;
      assert.equal(texels.length, 4 * width * height);
      assert.ok(texels.every((texel) => texel >= 0 && texel < Infinity));
    } catch (error) {
      checkRefusal(error, 'sky');
    }
  }
  assert.ok(read > 200 && read < 1800, `${read} were read`);
});
