// SPDX-License-Identifier: BSD-3-Clause
const kPickRadius = 9;  // pixels

/** What is drawn nearest to a place of the screen: {node} or {attempt}, or null. */
export function pick(scene, clientX, clientY) {
  const frame = scene.renderer.domElement.getBoundingClientRect();
  const x = clientX - frame.left;
  const y = clientY - frame.top;
  const {nodes} = scene.model;
  const places = new Map();
  const screen = (id) => {
    if (!places.has(id)) {
      const v = scene.placeOfNode(id).project(scene.camera);
      places.set(id, v.z > 1 || v.z < -1 ? null
                                         : [(v.x + 1) / 2 * frame.width, (1 - v.y) / 2 * frame.height]);
    }
    return places.get(id);
  };
  let best = null;
  let nearest = kPickRadius;
  const offer = (distance, item) => {
    if (distance >= nearest) return;
    nearest = distance;
    best = item;
  };
  for (const lines of scene.lines) {
    if (!lines.items.length || !lines.object.visible || !scene.floorShown[lines.floor]) continue;
    for (const attempt of lines.items) {
      const a = screen(attempt.a);
      const b = screen(attempt.b);
      if (!a || !b) continue;
      const [ux, uy] = [b[0] - a[0], b[1] - a[1]];
      const along = ux * ux + uy * uy;
      const t = along ? Math.min(1, Math.max(0, ((x - a[0]) * ux + (y - a[1]) * uy) / along)) : 0;
      offer(Math.hypot(a[0] + t * ux - x, a[1] + t * uy - y), {attempt});
    }
  }
  // A node lies on its lines: it wins within its own size.
  nearest = Math.min(nearest + 2, kPickRadius);
  for (let id = 0; id < nodes.count; ++id) {
    if (!scene.floorShown[nodes.floor[id]]) continue;
    if (!scene.shows(nodes.hasScan[id] ? 'scan_nodes' : 'odometry_nodes')) continue;
    const place = screen(id);
    if (place) offer(Math.hypot(place[0] - x, place[1] - y), {node: id});
  }
  return best;
}
