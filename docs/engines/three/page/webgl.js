// The stone by WebGLRenderer: modules of the cookbook in GLSL ES 3.00, before a shader of one's own.

import * as THREE from 'three';
import { fetched, load, run, show } from './stone.js';

/** The stone. The modules stand first, since GLSL wants functions before their calls. */
function gem(modules, main, { planes, stone, material }) {
  const { base_color, absorption, index, channel_indices } = material;
  const values = { planes, centre: stone.centre, base_color, absorption, index, channel_indices };
  return new THREE.ShaderMaterial({
    defines: { FACES: planes.length / 4, BOUNCES: 8 },
    uniforms: Object.fromEntries(Object.entries(values).map(([name, value]) => [name, { value }])),
    vertexShader: `
      in uint face;
      uniform vec3 centre;
      out vec3 v_position;
      flat out vec3 v_eye;
      flat out uint v_face;
      void main() {
        v_position = position - centre;
        v_eye = (inverse(modelMatrix) * vec4(cameraPosition, 1.0)).xyz - centre;
        v_face = face;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: modules + main,
  });
}

/** A triangle that covers the picture, with the backdrop that the recipe display puts behind a stone. */
function backdrop() {
  const material = new THREE.ShaderMaterial({
    uniforms: { size: { value: new THREE.Vector2() } },
    depthTest: false,
    depthWrite: false,
    vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
    fragmentShader: `
      uniform vec2 size;
      void main() {
        // Rows count from the bottom here, and from the top there.
        vec2 from_light = (gl_FragCoord.xy - vec2(0.5, 0.45) * size) / min(size.x, size.y);
        float falloff = exp(-3.0 * dot(from_light, from_light));
        gl_FragColor = vec4(mix(vec3(0.006, 0.007, 0.010), vec3(0.055, 0.062, 0.078), falloff), 1.0);
        #include <tonemapping_fragment>
        #include <colorspace_fragment>
      }`,
  });
  const corners = new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]);
  const geometry = new THREE.BufferGeometry().setAttribute('position', new THREE.BufferAttribute(corners, 3));
  const mesh = new THREE.Mesh(geometry, material);
  Object.assign(mesh, { frustumCulled: false, renderOrder: -1 });
  mesh.onBeforeRender = (renderer) => renderer.getDrawingBufferSize(material.uniforms.size.value);
  return mesh;
}

/** What a function draws on the canvas, as a file. */
function picture(renderer, draw) {
  draw();
  return new Promise((resolve) => renderer.domElement.toBlob(resolve));
}

run(async () => {
  const { geometry, camera, ...data } = await load('/out/scene.glb', '/out/frame');
  const [modules, main] = await Promise.all(['/out/gem.glsl', 'gem.frag'].map((path) => fetched(path)));
  const renderer = new THREE.WebGLRenderer({ antialias: false });
  // Khronos PBR Neutral, which the module srgb has too.
  renderer.toneMapping = THREE.NeutralToneMapping;
  const scene = new THREE.Scene();
  scene.add(backdrop(), new THREE.Mesh(geometry, gem(modules, main, data)));
  await show(renderer, camera, data.stone.centre, () => renderer.render(scene, camera), picture);
});
