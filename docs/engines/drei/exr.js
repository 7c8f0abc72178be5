// Linear pictures and their OpenEXR files, by three.js, whose rows start at the bottom.

import { readFileSync, writeFileSync } from 'node:fs';
import { DataTexture, DataUtils, FloatType, HalfFloatType, RGBAFormat } from 'three';
import { EXRExporter, ZIP_COMPRESSION } from 'three/addons/exporters/EXRExporter.js';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';

/** A black picture: red, green, blue and coverage of each texel, the top row first. */
export function picture(width, height) {
  return { width, height, texels: new Float32Array(4 * width * height) };
}

function flipped({ width, height, texels }, Kind) {
  const turned = new Kind(texels.length);
  for (let row = 0; row < height; row++) {
    turned.set(texels.subarray(4 * width * row, 4 * width * (row + 1)), 4 * width * (height - 1 - row));
  }
  return turned;
}

/** Writes a picture as 32-bit floats, or as 'half'. */
export async function writeExr(path, { width, height, texels }, type = 'float') {
  const half = type === 'half';
  const numbers = half ? Uint16Array.from(texels, DataUtils.toHalfFloat) : texels;
  const kind = half ? HalfFloatType : FloatType;
  const rows = flipped({ width, height, texels: numbers }, numbers.constructor);
  const texture = new DataTexture(rows, width, height, RGBAFormat, kind);
  writeFileSync(path, await new EXRExporter().parse(texture, { type: kind, compression: ZIP_COMPRESSION }));
}

/** Reads a picture of any compression and channels. */
export function readExr(path) {
  const bytes = readFileSync(path);
  const loader = new EXRLoader().setDataType(FloatType);
  const { data, width, height } = loader.parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  return { width, height, texels: flipped({ width, height, texels: data }, Float32Array) };
}
