// The stone by WebGPURenderer: the recipe gem_walk, included whole, and a wrapper of a few lines that
// hands it three.js's uniforms and buffers.

import * as THREE from 'three/webgpu';
import * as TSL from 'three/tsl';
import { fetched, load, run, show } from './stone.js';

/** A read-only storage buffer that WGSL knows as NAME.value. */
function buffer(name, numbers, type, size) {
  const values = new THREE.StorageBufferAttribute(numbers, size);
  return TSL.storage(values, type, values.count).toReadOnly().setName(name);
}

/** A recipe's text, with arrays where three.js declares them: NAME[i] is NAME.value[i] there. */
function withArrays(text, names) {
  for (const name of names) {
    const declaration = new RegExp(`^@group.* ${name}: .*$`, 'm');
    text = text.replace(declaration, '').replaceAll(new RegExp(`\\b${name}\\[`, 'g'), `${name}.value[`);
  }
  const left = text.match(/^@group.*$/m);
  if (left) throw new Error(`nothing is bound to ${left[0]}`);
  return text;
}

/** The radiance of the stone. */
function gem(recipe, { planes, facetMap, stone, material }) {
  // What is included is declared as well: the recipe, and the buffers that it reads by name.
  const included = [
    buffer('planes', planes, 'vec4', 4),
    buffer('facet_map', facetMap, 'uint', 1),
    TSL.wgsl(withArrays(recipe, ['planes', 'facet_map'])),
  ];
  const radiance = TSL.wgslFn(`
    fn stone_radiance(
      position: vec3f, face: u32, eye: vec3f, world_from_stone: mat4x4f,
      base_color: vec3f, index: f32, absorption: vec3f, channel_indices: vec3f,
      centre: vec3f, side: u32, lower: vec3f, upper: vec3f
    ) -> vec3f {
      view.eye = eye;
      material.index = index;
      material.channel_indices = channel_indices;
      let rows = transpose(world_from_stone);
      instances[0] = GemInstance(mat3x4f(rows[0], rows[1], rows[2]), base_color, absorption);
      stone = GemStone(centre, side, lower, upper);
      let seen = gem_radiance(GemVertex(vec4f(0.0), position, planes.value[face].xyz, face, 0u), true);
      return seen.surface + seen.inside;
    }
  `, included);
  const shaded = new THREE.MeshBasicNodeMaterial();
  shaded.colorNode = radiance({
    position: TSL.positionLocal,
    face: TSL.varying(TSL.attribute('face', 'uint')).setInterpolation('flat', 'either'),
    eye: TSL.cameraPosition,
    world_from_stone: TSL.modelWorldMatrix,
    base_color: TSL.uniform(material.base_color),
    index: TSL.uniform(material.index),
    absorption: TSL.uniform(material.absorption),
    channel_indices: TSL.uniform(material.channel_indices),
    centre: TSL.uniform(stone.centre),
    side: TSL.uniform(stone.side, 'uint'),
    lower: TSL.uniform(stone.lower),
    upper: TSL.uniform(stone.upper),
  });
  return shaded;
}

/** The backdrop that the recipe display puts behind a stone. */
function backdrop(text) {
  const radiance = TSL.wgslFn(`
    fn backdrop_radiance(pixel: vec2f, size: vec2f) -> vec3f {
      frame.size = size;
      return display_backdrop(pixel);
    }
  `, [TSL.wgsl(text)]);
  return radiance({ pixel: TSL.screenCoordinate, size: TSL.screenSize });
}

/**
 * What a function draws, as a file: from a texture that gets the tone curve and the encoding of the
 * canvas, since a headless Chromium may be unable to show a canvas of WebGPU.
 */
async function picture(renderer, draw) {
  const { width, height } = renderer.getDrawingBufferSize(new THREE.Vector2());
  const target = new THREE.RenderTarget(width, height);
  renderer.setOutputRenderTarget(target);
  draw();
  const bytes = await renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height);
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext('2d').putImageData(new ImageData(new Uint8ClampedArray(bytes), width, height), 0, 0);
  return canvas.convertToBlob();
}

run(async () => {
  const { geometry, camera, ...data } = await load('/out/scene.glb', '/out/frame');
  const [recipe, behind] = await Promise.all(['/out/gem.wgsl', '/out/backdrop.wgsl'].map((path) => fetched(path)));
  const renderer = new THREE.WebGPURenderer({ antialias: false });
  await renderer.init();
  if (!renderer.backend.isWebGPUBackend) throw new Error('this browser has no WebGPU');
  // Khronos PBR Neutral, which the module srgb has too.
  renderer.toneMapping = THREE.NeutralToneMapping;
  const scene = new THREE.Scene();
  scene.backgroundNode = backdrop(behind);
  scene.add(new THREE.Mesh(geometry, gem(recipe, data)));
  await show(renderer, camera, data.stone.centre, () => renderer.render(scene, camera), picture);
});
