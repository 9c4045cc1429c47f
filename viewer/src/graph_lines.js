// SPDX-License-Identifier: BSD-3-Clause
import {MovingLines} from './moving_lines.js';
import {closureStates} from './states.js';

// Heights above the floor at which things are drawn, so that none hides in another.
const kTrajectoryHeight = 0.1;
export const kGraphHeight = 0.25;
const kRouteHeight = 0.28;
const kHighlightHeight = 0.3;

const heights = {trajectory: kTrajectoryHeight, route: kRouteHeight};

export function nodeEnd(nodes, id) {
  return {
    before: nodes.before.subarray(3 * id, 3 * id + 2), after: nodes.after.subarray(3 * id, 3 * id + 2),
    from: nodes.floor[id], to: nodes.floor[id], fraction: 0,
  };
}

/** A cross that marks the place of a doubt. */
function cross({x, y, floor}) {
  const size = 1.2;
  const end = (dx, dy) => {
    const place = [x + dx, y + dy];
    return {before: place, after: place, from: floor, to: floor, fraction: 0};
  };
  return [end(-size, -size), end(size, size), end(-size, size), end(size, -size)];
}

/** A way through the building: pieces of it, each with its floor (-1: from one floor to the next). */
function* routePieces({legs}) {
  const end = (place, floor) => ({before: place, after: place, from: floor, to: floor, fraction: 0});
  let last = null;
  for (const {floor, points} of legs) {
    for (const point of points) {
      const next = end(point, floor);
      if (last) yield {floor: last.from === floor ? floor : -1, ends: [last, next]};
      last = next;
    }
  }
}

/** Trajectory, edges, attempts, doubts and a route, each with its layer and floor (-1: between floors). */
export function makeLines(model, materials) {
  const {trajectory, edges, attempts, nodes, doubts, route} = model;
  // layer -> floor (or -1: between floors) -> ends
  const sets = new Map();
  const add = (layer, floor, ends, items) => {
    const key = `${layer} ${floor}`;
    if (!sets.has(key)) sets.set(key, {layer, floor, ends: [], items: []});
    sets.get(key).ends.push(...ends);
    if (items) sets.get(key).items.push(items);
  };
  const sample = (i) => ({
    before: trajectory.before.subarray(3 * i, 3 * i + 2),
    after: trajectory.after.subarray(3 * i, 3 * i + 2),
    from: trajectory.height.from[i], to: trajectory.height.to[i],
    fraction: trajectory.height.fraction[i],
  });
  for (let i = 0; i + 1 < trajectory.count; ++i) {
    if (trajectory.breaks.has(i + 1)) continue;  // another drive begins
    const stays = !trajectory.inTransit[i] && !trajectory.inTransit[i + 1] &&
        trajectory.floor[i] === trajectory.floor[i + 1];
    add('trajectory', stays ? trajectory.floor[i] : -1, [sample(i), sample(i + 1)]);
  }
  const attempted = new Set(
      attempts.filter((attempt) => attempt.state === 'validated').map(({a, b}) => `${a} ${b}`));
  for (const edge of edges) {
    const {from, to, kind} = edge;
    if (kind === 'closure' && (attempted.has(`${from} ${to}`) || attempted.has(`${to} ${from}`))) continue;
    const floor = nodes.floor[from] === nodes.floor[to] ? nodes.floor[from] : -1;
    add(kind === 'closure' ? 'by_hand' : kind, floor, [nodeEnd(nodes, from), nodeEnd(nodes, to)]);
  }
  for (const attempt of attempts) {
    add(attempt.state, attempt.floor, [nodeEnd(nodes, attempt.a), nodeEnd(nodes, attempt.b)], attempt);
  }
  if (route) {
    for (const {floor, ends} of routePieces(route)) add('route', floor, ends);
  }
  for (const doubt of doubts) add('doubts', doubt.floor, cross(doubt));
  const all = [];
  for (const {layer, floor, ends, items} of sets.values()) {
    const lines = new MovingLines(
        ends, heights[layer] ?? kGraphHeight, materials[layer]);
    Object.assign(lines, {layer, floor, items});
    lines.object.renderOrder = layer === 'route' ? 3 : layer in closureStates ? 2 : 1;
    all.push(lines);
  }
  return all;
}

/** A frame around an item, {node} or {attempt}; null: around nothing. */
export function makeHighlight(item, nodes, material) {
  const ends = [];
  if (item?.attempt) ends.push(nodeEnd(nodes, item.attempt.a), nodeEnd(nodes, item.attempt.b));
  if (item && item.node !== undefined) {
    const end = nodeEnd(nodes, item.node);
    const corner = (dx, dy) => ({
      ...end, before: [end.before[0] + dx, end.before[1] + dy], after: [end.after[0] + dx, end.after[1] + dy],
    });
    const size = 0.6;
    const corners = [corner(size, 0), corner(0, size), corner(-size, 0), corner(0, -size)];
    corners.forEach((c, i) => ends.push(c, corners[(i + 1) % 4]));
  }
  const highlight = new MovingLines(ends, kHighlightHeight, material);
  highlight.object.renderOrder = 4;
  highlight.object.material.depthTest = false;
  return highlight;
}
