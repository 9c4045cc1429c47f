// SPDX-License-Identifier: BSD-3-Clause
import * as THREE from 'three';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';
import {nodeFragment, pointVertex, spaceFragment, spaceVertex} from './shaders.js';
import {closureStates} from './states.js';

function cssColour(name) {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  return new THREE.Color(text);
}

export function makeMaterials(space) {
  const line = (width, more) => new LineMaterial({linewidth: width, ...more});
  const materials = {
    trajectory: line(1.4, {transparent: true, opacity: 0.9}),
    odometry: line(1.6),
    floor_change: line(2.4, {dashed: true, dashSize: 0.5, gapSize: 0.35}),
    by_hand: line(2.4),
    doubts: line(4),
    route: line(5),
    highlight: line(5),
  };
  for (const [state, look] of Object.entries(closureStates)) materials[state] = line(look.width);
  const node = (diameter, least) => new THREE.ShaderMaterial({
    uniforms: {
      colour: {value: new THREE.Color()}, rim: {value: new THREE.Color()},
      pixelsPerMetre: {value: 1}, diameter: {value: diameter}, least: {value: least},
    },
    vertexShader: pointVertex, fragmentShader: nodeFragment,
  });
  if (space) {
    materials.space = new THREE.ShaderMaterial({
      uniforms: {
        lowColour: {value: new THREE.Color()}, highColour: {value: new THREE.Color()},
        pixelsPerMetre: {value: 1}, diameter: {value: space.spacing},
        band: {value: new THREE.Vector2(space.lowest, space.highest)},
        reach: {value: new THREE.Vector2(space.lowest, space.highest)},
      },
      vertexShader: spaceVertex, fragmentShader: spaceFragment,
    });
  }
  materials.scan_nodes = node(0.5, 3.6);
  materials.odometry_nodes = node(0.35, 2.6);
  return materials;
}

/** Everything in the colours of the page, which are light or dark. Gives the background. */
export function applyColours(materials, floorGroups) {
  const background = cssColour('--canvas');
  const dark = background.getHSL({}).l < 0.4;
  const shade = (colour, toward, share) => colour.clone().lerp(toward, share);
  for (const {floor, free, walls, scans} of floorGroups) {
    const hue = new THREE.Color(floor.colour);
    const ink = dark ? shade(hue, new THREE.Color('#ffffff'), 0.3)
                     : shade(hue, new THREE.Color('#000000'), 0.45);
    if (free) {
      free.material.color = shade(background, hue, dark ? 0.2 : 0.24);
      free.material.opacity = 0.85;
    }
    if (walls) {
      walls.userData.points.material.uniforms.colour.value.copy(ink);
      walls.userData.columns.material.uniforms.footColour.value.copy(shade(ink, background, 0.5));
    }
    if (scans) scans.material.uniforms.colour.value.copy(ink);
  }
  const colours = {
    trajectory: '--trajectory', odometry: '--odometry', floor_change: '--floor-change',
    by_hand: '--by-hand', doubts: '--audited', route: '--route', highlight: '--highlight',
  };
  for (const [state, look] of Object.entries(closureStates)) colours[state] = look.colour;
  for (const [name, variable] of Object.entries(colours)) materials[name].color = cssColour(variable);
  if (materials.space) {
    materials.space.uniforms.lowColour.value = cssColour('--space-low');
    materials.space.uniforms.highColour.value = cssColour('--space-high');
  }
  for (const [name, variable] of [['scan_nodes', '--node'], ['odometry_nodes', '--odometry']]) {
    materials[name].uniforms.colour.value = cssColour(variable);
    materials[name].uniforms.rim.value = background;
  }
  return background;
}
