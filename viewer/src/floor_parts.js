// SPDX-License-Identifier: BSD-3-Clause
import * as THREE from 'three';
import {flatFragment, pointVertex, scanVertex, wallFragment, wallVertex} from './shaders.js';

function makeFree({free}, origin) {
  if (!free.width || !free.height) return null;
  const texels = new Uint8Array(free.width * free.height);
  const rowBytes = Math.ceil(free.width / 8);
  for (let row = 0; row < free.height; ++row) {
    for (let column = 0; column < free.width; ++column) {
      const byte = free.bits[row * rowBytes + (column >> 3)];
      texels[row * free.width + column] = byte >> (column & 7) & 1 ? 255 : 0;
    }
  }
  const texture = new THREE.DataTexture(texels, free.width, free.height, THREE.RedFormat);
  texture.unpackAlignment = 1;
  texture.magFilter = THREE.LinearFilter;
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = 4;
  texture.needsUpdate = true;
  const width = free.width * free.cell_m;
  const height = free.height * free.cell_m;
  const material = new THREE.MeshBasicMaterial({
    alphaMap: texture, transparent: true, depthWrite: false, side: THREE.DoubleSide,
  });
  // alphaMap reads the green channel.
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
        '#include <alphamap_fragment>', 'diffuseColor.a *= texture2D(alphaMap, vAlphaMapUv).r;');
  };
  const plane = new THREE.Mesh(new THREE.PlaneGeometry(width, height), material);
  plane.position.set(free.origin[0] + width / 2 - origin.x,
                     free.origin[1] + height / 2 - origin.y, 0);
  return plane;
}

function makeWalls({walls}, origin) {
  if (!walls.count) return null;
  const feet = new Float32Array(walls.count * 2);
  for (let i = 0; i < walls.count; ++i) {
    feet[2 * i] = walls.origin[0] - origin.x + walls.xy[2 * i] * walls.step_m;
    feet[2 * i + 1] = walls.origin[1] - origin.y + walls.xy[2 * i + 1] * walls.step_m;
  }
  const places = new Float32Array(walls.count * 3);
  for (let i = 0; i < walls.count; ++i) {
    places[3 * i] = feet[2 * i];
    places[3 * i + 1] = feet[2 * i + 1];
    places[3 * i + 2] = 0.02;
  }
  const colour = {value: new THREE.Color()};
  const opacity = {value: 1};
  const points = new THREE.Points(new THREE.BufferGeometry(), new THREE.ShaderMaterial({
    uniforms: {colour, opacity, pixelsPerMetre: {value: 1}, diameter: {value: walls.spacing_m * 1.3},
               least: {value: 1.3}},
    vertexShader: pointVertex, fragmentShader: flatFragment, transparent: true,
  }));
  points.geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
  const standing = new THREE.InstancedBufferGeometry();
  standing.setAttribute('position', new THREE.Float32BufferAttribute([0, 0, 0, 0, 0, 1], 3));
  standing.setAttribute('foot', new THREE.InstancedBufferAttribute(feet, 2));
  const columns = new THREE.LineSegments(standing, new THREE.ShaderMaterial({
    uniforms: {colour, footColour: {value: new THREE.Color()}, opacity, wallHeight: {value: 0}},
    vertexShader: wallVertex, fragmentShader: wallFragment, transparent: true,
  }));
  columns.frustumCulled = points.frustumCulled = false;
  const group = new THREE.Group();
  group.add(points, columns);
  group.userData = {points, columns};
  return group;
}

// Points of scans, moved by the graphics card from before to after.
function makeScans(floor, scans) {
  const chosen = [];
  let first = 0;
  let total = 0;
  for (let i = 0; i < scans.count; ++i) {
    if (scans.floor[i] === floor.index) {
      chosen.push({i, first});
      total += scans.points[i];
    }
    first += scans.points[i];
  }
  if (!total) return null;
  const width = 1024;
  const texels = new Float32Array(width * Math.ceil(chosen.length * 2 / width) * 4);
  const points = new Float32Array(total * 2);
  const scan = new Float32Array(total);
  let place = 0;
  chosen.forEach(({i, first}, order) => {
    // The short way round.
    const turn = scans.after[3 * i + 2] - scans.before[3 * i + 2];
    const before = scans.after[3 * i + 2] - Math.atan2(Math.sin(turn), Math.cos(turn));
    texels.set([scans.before[3 * i], scans.before[3 * i + 1], before, 0], order * 8);
    texels.set([...scans.after.subarray(3 * i, 3 * i + 3), 0], order * 8 + 4);
    for (let k = first; k < first + scans.points[i]; ++k, ++place) {
      points[2 * place] = scans.xy[2 * k] * scans.step;
      points[2 * place + 1] = scans.xy[2 * k + 1] * scans.step;
      scan[place] = order;
    }
  });
  const poses = new THREE.DataTexture(texels, width, texels.length / 4 / width, THREE.RGBAFormat,
                                      THREE.FloatType);
  poses.needsUpdate = true;
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(points, 2));  // in robot
  // Where they are in world only the graphics card knows.
  geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), Infinity);
  geometry.setAttribute('scan', new THREE.BufferAttribute(scan, 1));
  const object = new THREE.Points(geometry, new THREE.ShaderMaterial({
    uniforms: {colour: {value: new THREE.Color()}, opacity: {value: 0.7}, poses: {value: poses},
               blend: {value: 1}},
    vertexShader: scanVertex, fragmentShader: flatFragment, transparent: true,
  }));
  object.frustumCulled = false;
  return object;
}

function makeSpace({space}, origin, material) {
  if (!space) return null;
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(space.xyz, 3));
  const points = new THREE.Points(geometry, material);
  points.position.set(-origin.x, -origin.y, 0);
  points.frustumCulled = false;
  return points;
}

function makeNodes(floor, nodes, withScan) {
  const ids = [];
  for (let i = 0; i < nodes.count; ++i) {
    if (nodes.floor[i] === floor.index && Boolean(nodes.hasScan[i]) === withScan) ids.push(i);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(ids.length * 3), 3));
  const object = new THREE.Points(geometry);
  object.frustumCulled = false;
  object.renderOrder = 3;
  return {ids, object};
}

/** All that is drawn of one floor but lines: {group, floor, free, walls, scans, space, scan_nodes, odometry_nodes}. */
export function makeFloor(floor, model, origin, materials) {
  const group = new THREE.Group();
  const parts = {group, floor};
  parts.free = makeFree(floor, origin);
  parts.walls = makeWalls(floor, origin);
  parts.scans = makeScans(floor, model.scans);
  parts.space = makeSpace(floor, origin, materials.space);
  for (const name of ['scan_nodes', 'odometry_nodes']) {
    parts[name] = makeNodes(floor, model.nodes, name === 'scan_nodes');
    parts[name].object.material = materials[name];
  }
  group.add(...[parts.free, parts.walls, parts.scans, parts.space].filter(Boolean),
            parts.scan_nodes.object, parts.odometry_nodes.object);
  return parts;
}
