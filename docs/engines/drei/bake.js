// Bakes Lapidary's studio into a latitude-longitude image, so that both sides are lit by the same
// texels. The formula is environment_studio of wgsl/environment.wgsl, in double precision.
// Usage: node bake.js FILE.exr

import { picture, writeExr } from './exr.js';

const WIDTH = 1024;
const HEIGHT = 512;

// Axis, up, half size, softness and radiance of each light. The axes are rational unit vectors.
const LIGHTS = [
  { axis: [-2 / 7, 6 / 7, 3 / 7], up: [6 / 7, 3 / 7, -2 / 7], half: [0.28, 0.28], soft: 0.05, radiance: [9, 8.4, 7.2] },
  { axis: [0, 24 / 25, -7 / 25], up: [0, 7 / 25, 24 / 25], half: [0.7, 0.06], soft: 0.03, radiance: [13, 13, 13] },
  { axis: [6 / 7, 3 / 7, 2 / 7], up: [-2 / 7, 6 / 7, -3 / 7], half: [0.08, 0.45], soft: 0.04, radiance: [7, 8.6, 10] },
  { axis: [-2 / 3, 1 / 3, -2 / 3], up: [2 / 3, 2 / 3, -1 / 3], half: [0.09, 0.4], soft: 0.04, radiance: [9, 7.2, 5] },
  { axis: [4 / 9, 7 / 9, -4 / 9], up: [1 / 9, 4 / 9, 8 / 9], half: [0.08, 0.08], soft: 0.03, radiance: [20, 19, 17] },
  { axis: [1 / 3, 2 / 3, 2 / 3], up: [-2 / 3, 2 / 3, -1 / 3], half: [0.07, 0.07], soft: 0.03, radiance: [15, 16, 18] },
  { axis: [2 / 7, 3 / 7, -6 / 7], up: [6 / 7, 2 / 7, 3 / 7], half: [0.06, 0.06], soft: 0.03, radiance: [16, 16, 16] },
  { axis: [0, -3 / 5, -4 / 5], up: [0, 4 / 5, -3 / 5], half: [0.6, 0.2], soft: 0.1, radiance: [2.6, 2.75, 2.9] },
  { axis: [0, -5 / 13, 12 / 13], up: [0, 12 / 13, 5 / 13], half: [0.5, 0.14], soft: 0.1, radiance: [2, 1.85, 1.7] },
];
const GROUND = [0.025, 0.024, 0.026];
const ZENITH = [0.26, 0.3, 0.38];

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

function coverage(direction, { axis, up, half, soft }) {
  const depth = dot(direction, axis);
  if (depth <= 0) return 0;
  const position = [dot(direction, cross(up, axis)) / depth, dot(direction, up) / depth];
  const edge = (side) => {
    const t = Math.min(Math.max((half[side] + soft - Math.abs(position[side])) / (2 * soft), 0), 1);
    return t * t * (3 - 2 * t);
  };
  return edge(0) * edge(1);
}

function studio(direction) {
  const height = (0.5 + 0.5 * direction[1]) ** 2;
  const sum = [0, 1, 2].map((c) => GROUND[c] * (1 - height) + ZENITH[c] * height);
  for (const light of LIGHTS) {
    const share = coverage(direction, light);
    for (const c of [0, 1, 2]) sum[c] += share * light.radiance[c];
  }
  return sum;
}

// u = 1/2 is +X, u = 3/4 is +Z; v = 0, the first row, is the zenith (docs/environment.md).
const map = picture(WIDTH, HEIGHT);
for (let row = 0; row < HEIGHT; row++) {
  const polar = (Math.PI * (row + 0.5)) / HEIGHT;
  for (let column = 0; column < WIDTH; column++) {
    const azimuth = 2 * Math.PI * ((column + 0.5) / WIDTH - 0.5);
    const [x, z] = [Math.sin(polar) * Math.cos(azimuth), Math.sin(polar) * Math.sin(azimuth)];
    map.texels.set([...studio([x, Math.cos(polar), z]), 1], 4 * (row * WIDTH + column));
  }
}
// Half floats, which every texture unit filters: nothing is left to be rounded by one side only.
writeExr(process.argv[2], map, 'half');
