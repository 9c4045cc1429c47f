// SPDX-License-Identifier: BSD-3-Clause
import * as THREE from 'three';

/** Direction of the longer axis of the nodes, rad, so that the first view has it across. */
function longAxis({after, count}) {
  let [xx, xy, yy] = [0, 0, 0];
  for (let i = 0; i < count; ++i) {
    const x = after[3 * i];
    const y = after[3 * i + 1];
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  return Math.atan2(2 * xy, xx - yy) / 2;
}

/**
 * Moves the poses so that the middle of what is drawn is the scene's origin: a graphics card counts in
 * single precision. Gives where that is, how far all reaches, and the direction of its longer axis.
 */
export function centre(model) {
  const box = new THREE.Box2();
  const {floors, nodes} = model;
  for (const {free} of floors) {
    if (!free.width) continue;
    box.expandByPoint(new THREE.Vector2(...free.origin));
    box.expandByPoint(new THREE.Vector2(free.origin[0] + free.width * free.cell_m,
                                        free.origin[1] + free.height * free.cell_m));
  }
  for (let i = 0; i < nodes.count; ++i) {
    box.expandByPoint(new THREE.Vector2(nodes.after[3 * i], nodes.after[3 * i + 1]));
  }
  if (box.isEmpty()) box.set(new THREE.Vector2(-5, -5), new THREE.Vector2(5, 5));
  const origin = box.getCenter(new THREE.Vector2());
  const size = box.getSize(new THREE.Vector2());
  const moved = (poses) => {
    for (let i = 0; i < poses.length; i += 3) {
      poses[i] -= origin.x;
      poses[i + 1] -= origin.y;
    }
  };
  for (const table of [nodes, model.trajectory, model.scans]) {
    moved(table.before);
    moved(table.after);
  }
  for (const doubt of model.doubts) {
    doubt.x -= origin.x;
    doubt.y -= origin.y;
  }
  for (const {points} of model.route?.legs ?? []) {
    for (const point of points) {
      point[0] -= origin.x;
      point[1] -= origin.y;
    }
  }
  return {origin, extent: Math.max(size.x, size.y, 5), course: longAxis(nodes)};
}
