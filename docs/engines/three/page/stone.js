// The stone, the camera and the picture: what both pages share. Nothing here knows a renderer.

import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

// Whether the page is to send its picture, and not to be looked at.
const CHECKED = new URL(location.href).searchParams.has('check');
// Of the page's pixels, along each side.
const SIZE = 512;

/** Fetches a file, as text, JSON or bytes. */
export async function fetched(path, as = 'text') {
  const response = await fetch(path);
  if (!response.ok) throw new Error(`${path}: ${response.status}`);
  return response[as]();
}

/**
 * What `cook frame` has computed for the stone: buffers by name, and structs by name and field. It is
 * made once for a cut, like a texture; a page needs these few files of the frame alone.
 */
async function cut(folder) {
  const { resources } = await fetched(`${folder}/frame.json`, 'json');
  const rows = Object.groupBy(resources.filter((row) => row.contents), (row) => row.name.split('/').at(-1));
  if (rows.instances) throw new Error(`${folder}: copies of a stone, which this page does not draw`);
  const bytes = (name) => {
    if (rows[name]?.length !== 1) throw new Error(`${folder}: needs one stone, drawn by a rung walk-HITS`);
    return fetched(`${folder}/${rows[name][0].contents}`, 'arrayBuffer');
  };
  const fields = async (name) => {
    const view = new DataView(await bytes(name));
    return Object.fromEntries(rows[name][0].layout.fields.map(({ name, type, offset }) => {
      if (type === 'u32') return [name, view.getUint32(offset, true)];
      if (type === 'f32') return [name, view.getFloat32(offset, true)];
      return [name, new THREE.Vector3(...[0, 4, 8].map((byte) => view.getFloat32(offset + byte, true)))];
    }));
  };
  return {
    // Normal and distance of each facet's plane, about the stone's centre.
    planes: new Float32Array(await bytes('planes')),
    faceOfTriangle: new Uint32Array(await bytes('face of triangle')),
    facetMap: new Uint32Array(await bytes('facet map')),
    stone: await fields('stone'),
    material: await fields('material'),
  };
}

/**
 * Loads a scene of one stone. Returns the stone's data, its geometry with the number of each triangle's
 * facet, and the file's camera. Data and geometry are where the file has them in its world: that is the
 * stone's own space here, and a mesh may move it on.
 */
export async function load(sceneUrl, frameUrl) {
  const [gltf, data] = await Promise.all([new GLTFLoader().loadAsync(sceneUrl), cut(frameUrl)]);
  const meshes = [];
  gltf.scene.updateMatrixWorld(true);
  gltf.scene.traverse((node) => node.isMesh && meshes.push(node));
  const [camera] = gltf.cameras;
  if (meshes.length !== 1 || !camera) throw new Error(`${sceneUrl}: needs one mesh and a camera`);
  // Free of the file's nodes, which nobody draws and which would not follow it.
  camera.matrixWorld.decompose(camera.position, camera.quaternion, camera.scale);
  camera.removeFromParent();
  // Without indices, since vertices are shared by facets and the facet's number is not.
  const geometry = meshes[0].geometry.toNonIndexed().applyMatrix4(meshes[0].matrixWorld);
  const { count } = geometry.attributes.position;
  if (count !== 3 * data.faceOfTriangle.length) throw new Error(`${sceneUrl}: another mesh than in ${frameUrl}`);
  const faces = Uint32Array.from({ length: count }, (_, vertex) => data.faceOfTriangle[Math.floor(vertex / 3)]);
  geometry.setAttribute('face', new THREE.BufferAttribute(faces, 1));
  return { ...data, geometry, camera };
}

/**
 * Shows what `draw` draws, to be turned by hand. A page that is checked sends one picture instead, as
 * `picture` makes it.
 */
export async function show(renderer, camera, centre, draw, picture) {
  const canvas = renderer.domElement;
  document.querySelector('main').append(canvas);
  if (CHECKED) {
    // One sample a pixel, as in the picture that it is compared with.
    renderer.setPixelRatio(1);
    renderer.setSize(SIZE, SIZE);
    return send('/picture', await picture(renderer, draw));
  }
  // Edges seen through facets need samples. MSAA smooths those of triangles alone.
  renderer.setPixelRatio(Math.max(2, devicePixelRatio));
  renderer.setSize(SIZE, SIZE);
  // Turned about a point on the line of sight, so that the first picture is the file's.
  const forward = camera.getWorldDirection(new THREE.Vector3());
  const distance = forward.dot(centre.clone().sub(camera.position));
  const controls = new OrbitControls(camera, canvas);
  controls.target.copy(camera.position).addScaledVector(forward, distance);
  controls.update();
  renderer.setAnimationLoop(draw);
}

async function send(path, body) {
  const response = await fetch(path, { method: 'POST', body });
  if (!response.ok) throw new Error(`${path}: ${response.status}`);
}

/** Runs a page. What fails is shown, and ends a check. */
export async function run(page) {
  // three.js tells of shaders that do not compile, and goes on without them.
  const told = [];
  THREE.setConsoleFunction((kind, ...words) => {
    console[kind](...words);
    if (kind === 'error') told.push(words.join(' '));
  });
  try {
    await page();
    if (told.length > 0) throw new Error(told[0]);
    if (CHECKED) await send('/done', '');
  } catch (error) {
    document.querySelector('main').textContent = error.message;
    if (CHECKED) await send('/failed', told[0] ?? error.message);
  }
}
