// Whether drei sees the environment where docs/environment.md has it, through the same camera: the
// picture without a stone is compared with the map, looked up in the direction of each pixel.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { readExr } from './exr.js';

/** Radiance of a channel of a map in a direction, bilinear; columns wrap. */
function lookup({ width, height, texels }, [x, y, z], channel) {
  const column = (0.5 + Math.atan2(z, x) / (2 * Math.PI)) * width - 0.5;
  const row = Math.min(Math.max((Math.atan2(Math.hypot(x, z), y) / Math.PI) * height - 0.5, 0), height - 1);
  const [left, top] = [Math.floor(column), Math.floor(row)];
  const texel = (right, down) => {
    const place = [(left + right + width) % width, Math.min(top + down, height - 1)];
    return texels[4 * (place[1] * width + place[0]) + channel];
  };
  const mix = (a, b, weight) => a + (b - a) * weight;
  const across = (down) => mix(texel(0, down), texel(1, down), column - left);
  return mix(across(0), across(1), row - top);
}

/** The matrix from the world to clip space of a frame's first view, by columns. */
function matrix(folder) {
  const { resources } = JSON.parse(readFileSync(join(folder, 'frame.json')));
  const { contents, layout } = resources.find((row) => row.name === 'view' && row.layout);
  const { offset } = layout.fields.find((field) => field.name === 'clip_from_world');
  const bytes = readFileSync(join(folder, contents));
  return Array.from({ length: 16 }, (_, place) => bytes.readFloatLE(offset + 4 * place));
}

/** The direction in which a camera sees the point (x, y) of clip space, of any length. */
function direction(clip, x, y) {
  // Points in that direction, far away, keep both ratios: clip.x = x clip.w and clip.y = y clip.w.
  const plane = (row, ratio) => [0, 1, 2].map((axis) => clip[4 * axis + row] - ratio * clip[4 * axis + 3]);
  const [a, b] = [plane(0, x), plane(1, y)];
  const along = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const forward = clip[3] * along[0] + clip[7] * along[1] + clip[11] * along[2] > 0;
  return forward ? along : along.map((part) => -part);
}

/** Largest difference of a picture without a stone from the map, in red, green and blue. */
export function straightError(out, view) {
  const map = readExr(join(out, 'environment.exr'));
  const seen = readExr(join(out, 'pictures', view, 'straight.exr'));
  const clip = matrix(join(out, 'frames', view, 'camera'));
  let worst = 0;
  for (let row = 0; row < seen.height; row++) {
    for (let column = 0; column < seen.width; column++) {
      const place = 4 * (row * seen.width + column);
      if (seen.texels[place + 3] < 0.5) continue;
      const along = direction(clip, (2 * (column + 0.5)) / seen.width - 1, 1 - (2 * (row + 0.5)) / seen.height);
      for (const channel of [0, 1, 2]) {
        worst = Math.max(worst, Math.abs(seen.texels[place + channel] - lookup(map, along, channel)));
      }
    }
  }
  return worst;
}
