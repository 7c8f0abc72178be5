// The stone by drei's MeshRefractionMaterial, drawn as linear radiance into a float target.
// The settings are those of drei's own component, which does the same for React.

import { MeshRefractionMaterial } from '@react-three/drei/materials/MeshRefractionMaterial.js';
import * as THREE from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshBVH, MeshBVHUniformStruct, SAH } from 'three-mesh-bvh';

/** Defines that drei's component derives from the width of a latitude-longitude map. */
function mapDefines(width) {
  const levels = Math.floor(Math.log2(width / 4));
  const texels = [3 * Math.max(2 ** levels, 112), 4 * 2 ** levels];
  return {
    CUBEUV_TEXEL_WIDTH: `${1 / texels[0]}`,
    CUBEUV_TEXEL_HEIGHT: `${1 / texels[1]}`,
    CUBEUV_MAX_MIP: `${levels}.0`,
  };
}

/** The only mesh of a scene, with the normals of its facets, and its material's refractive index. */
async function stone(url) {
  const { scene } = await new GLTFLoader().loadAsync(url);
  scene.updateMatrixWorld(true);
  const meshes = [];
  scene.traverse((node) => node.isMesh && meshes.push(node));
  if (meshes.length !== 1) throw new Error(`${url}: ${meshes.length} meshes`);
  // The file's normals are shared by facets. Without them and without indices each facet is flat.
  const geometry = meshes[0].geometry.toNonIndexed().applyMatrix4(meshes[0].matrixWorld);
  geometry.deleteAttribute('normal');
  geometry.computeVertexNormals();
  return { geometry, index: meshes[0].material.ior };
}

export class Drei {
  /** Loads a scene of one stone and a latitude-longitude map. */
  static async load(sceneUrl, mapUrl, size) {
    const drei = new Drei();
    drei.size = size;
    drei.renderer = new THREE.WebGLRenderer({ antialias: false, powerPreference: 'high-performance' });
    drei.renderer.toneMapping = THREE.NoToneMapping;
    drei.renderer.setClearColor(0x000000, 0);
    const filters = { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter };
    drei.target = new THREE.WebGLRenderTarget(size, size, { type: THREE.FloatType, ...filters });
    drei.map = await new EXRLoader().setDataType(THREE.HalfFloatType).loadAsync(mapUrl);
    // As three.js loads a panorama for drei, without mipmaps; but no border where the ends meet.
    Object.assign(drei.map, { wrapS: THREE.RepeatWrapping, minFilter: THREE.LinearFilter, generateMipmaps: false });
    const { geometry, index } = await stone(sceneUrl);
    drei.index = index;
    drei.bvh = new MeshBVHUniformStruct();
    drei.bvh.updateFrom(new MeshBVH(geometry.clone(), { strategy: SAH }));
    drei.materials = new Map();
    drei.mesh = new THREE.Mesh(geometry);
    drei.mesh.frustumCulled = false;
    drei.scene = new THREE.Scene();
    drei.scene.add(drei.mesh);
    drei.camera = new THREE.Camera();
    return drei;
  }

  get driver() {
    const gl = this.renderer.getContext();
    const names = gl.getExtension('WEBGL_debug_renderer_info');
    return gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  }

  /** Looks through a camera of WebGPU: its matrix from the world to clip space, and its eye. */
  look({ clip, eye }) {
    // The view only moves the eye to the origin; all else, and the depth of -w to w that WebGL
    // has instead of 0 to w, goes to the projection. Any camera can be divided so.
    const depth = new THREE.Matrix4().set(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, -1, 0, 0, 0, 1);
    const { camera } = this;
    camera.position.set(...eye);
    camera.updateMatrixWorld();
    camera.projectionMatrix.fromArray(clip).premultiply(depth).multiply(camera.matrixWorld);
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  }

  #material(technique) {
    if (!this.materials.has(technique.name)) {
      const defines = mapDefines(this.map.image.width);
      if (technique.aberration > 0) defines.CHROMATIC_ABERRATIONS = '';
      if (technique.fast) defines.FAST_CHROMA = '';
      const material = new MeshRefractionMaterial({ defines });
      material.envMap = this.map;
      material.bvh = this.bvh;
      material.ior = technique.index ?? this.index;
      material.bounces = technique.bounces;
      material.aberrationStrength = technique.aberration;
      material.fresnel = technique.fresnel;
      material.resolution = new THREE.Vector2(this.size, this.size);
      material.viewMatrixInverse = this.camera.matrixWorld;
      material.projectionMatrixInverse = this.camera.projectionMatrixInverse;
      this.materials.set(technique.name, material);
    }
    return this.materials.get(technique.name);
  }

  /** Submits the picture of a technique. */
  draw(technique) {
    this.mesh.material = this.#material(technique);
    this.renderer.setRenderTarget(this.target);
    this.renderer.render(this.scene, this.camera);
  }

  /** Waits until everything submitted is drawn: a texel cannot be read earlier. */
  finish() {
    this.renderer.readRenderTargetPixels(this.target, 0, 0, 1, 1, new Float32Array(4));
  }

  /** Reads what was drawn: linear red, green, blue and coverage, the top row first. */
  read() {
    const { size } = this;
    const upward = new Float32Array(4 * size * size);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, size, size, upward);
    const texels = new Float32Array(upward.length);
    for (let row = 0; row < size; row++) {
      texels.set(upward.subarray(4 * size * row, 4 * size * (row + 1)), 4 * size * (size - 1 - row));
    }
    return { width: size, height: size, texels };
  }
}
