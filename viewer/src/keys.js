// SPDX-License-Identifier: BSD-3-Clause
import * as THREE from 'three';

/** Turns, moves and zooms the scene as a key says; whether it is such a key. */
export function followKey(scene, event) {
  const turn = 0.08;
  const offset = scene.camera.position.clone().sub(scene.controls.target);
  const spherical = new THREE.Spherical().setFromVector3(
      new THREE.Vector3(offset.x, offset.z, -offset.y));
  const put = () => {
    const turned = new THREE.Vector3().setFromSpherical(spherical);
    scene.camera.position.copy(scene.controls.target)
        .add(new THREE.Vector3(turned.x, -turned.z, turned.y));
  };
  const move = (right, forward) => {
    const step = offset.length() * 0.06;
    const heading = new THREE.Vector3(-offset.x, -offset.y, 0);
    if (heading.lengthSq() < 1e-9) heading.set(0, 1, 0);
    heading.normalize();
    const way = new THREE.Vector3(heading.y, -heading.x, 0).multiplyScalar(right * step)
        .addScaledVector(heading, forward * step);
    scene.controls.target.add(way);
    scene.camera.position.add(way);
  };
  const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
  if (event.ctrlKey || event.metaKey || event.altKey) return false;
  if (event.key in arrows) {
    const [right, forward] = arrows[event.key];
    if (event.shiftKey) {
      move(right, forward);
    } else {
      spherical.theta -= right * turn;
      spherical.phi = Math.min(Math.PI / 2, Math.max(0.001, spherical.phi - forward * turn));
      put();
    }
  } else if (event.key === '+' || event.key === '=') {
    spherical.radius *= 0.9;
    put();
  } else if (event.key === '-' || event.key === '_') {
    spherical.radius /= 0.9;
    put();
  } else if (event.key === '0' || event.key === 'Home') {
    scene.look();
  } else {
    return false;
  }
  return true;
}
