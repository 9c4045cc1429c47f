// SPDX-License-Identifier: BSD-3-Clause
// The page's data (src/export/report.cpp writes it) as columns of numbers. Metres, radians, seconds.

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

const kinds = {
  u8: Uint8Array, u16: Uint16Array, i16: Int16Array, u32: Uint32Array, i32: Int32Array,
  f32: Float32Array, f64: Float64Array,
};

/** The column `name` of a table, whose ending says its type. */
function column(table, name) {
  const kind = kinds[name.slice(name.lastIndexOf('_') + 1)];
  return new kind(bytesOf(table[name]).buffer);
}

function poses(table) {
  return {before: column(table, 'before_f32'), after: column(table, 'after_f32')};
}

/** Floors at one elevation share a storey; storeys are numbered upwards. */
function storeys(floors) {
  const elevations = [...new Set(floors.map((floor) => floor.elevation_m))].sort((a, b) => a - b);
  return floors.map((floor) => elevations.indexOf(floor.elevation_m));
}

/**
 * Between two floors the trajectory has no height of its own: it is drawn as a straight way from
 * the one to the other. Each sample gets the two floors and the fraction of the way.
 */
function heights(floor, inTransit) {
  const from = new Uint16Array(floor);
  const to = new Uint16Array(floor);
  const fraction = new Float32Array(floor.length);
  for (let i = 0; i < floor.length; ++i) {
    if (!inTransit[i]) continue;
    let end = i;
    while (end < floor.length && inTransit[end]) ++end;
    const target = end < floor.length ? floor[end] : floor[i];
    for (let k = i; k < end; ++k) {
      to[k] = target;
      fraction[k] = (k - i + 1) / (end - i + 1);
    }
    i = end - 1;
  }
  return {from, to, fraction};
}

function readTrajectory(table) {
  const floor = column(table, 'floor_u16');
  const inTransit = column(table, 'in_transit_u8');
  return {
    count: table.count, length: table.length_m, stamp: column(table, 'stamp_f64'), floor, inTransit,
    height: heights(floor, inTransit), ...poses(table),
    breaks: new Set(table.breaks ?? []),
  };
}

function readAttempts(table, nodes) {
  const a = column(table, 'a_i32');
  const b = column(table, 'b_i32');
  const votes = column(table, 'votes_i32');
  const state = column(table, 'state_u8');
  const reason = column(table, 'reason_u32');
  const match = column(table, 'match_f32');
  const quality = column(table, 'quality_f32');
  return Array.from(a, (_, i) => {
    const name = table.states[state[i]];
    const matched = name !== 'rejected_score';
    return {
      index: i, a: a[i], b: b[i], floor: nodes.floor[a[i]],
      tA: nodes.stamp[a[i]], tB: nodes.stamp[b[i]],
      state: name, reason: table.reasons[reason[i]], votes: votes[i],
      dx: match[3 * i], dy: match[3 * i + 1], dtheta: match[3 * i + 2],
      score: quality[5 * i], mahalanobis: quality[5 * i + 1], agreement: quality[5 * i + 2],
      // Without a match there is nothing to be wrong by.
      error: matched ? quality[5 * i + 3] : NaN,
      angleError: matched ? quality[5 * i + 4] : NaN,
    };
  });
}

/** Points of a 3D lidar on a floor, z above it; null where the map keeps none. */
function spaceOf(space, floor) {
  const points = space?.floors[floor];
  if (!points?.count) return null;
  const xyz = Float32Array.from(column(points, 'xyz_u16'), (steps, i) =>
      points.origin[i % 3] + steps * points.step_m);
  return {count: points.count, xyz};
}

/** Of all floors' points: how large each is, and the heights above their floors between which they lie. */
function aboutSpace(space, floors) {
  const shown = floors.filter((floor) => floor.space);
  if (!shown.length) return null;
  let [lowest, highest] = [Infinity, -Infinity];
  for (const {space: {xyz}} of shown) {
    for (let i = 2; i < xyz.length; i += 3) {
      lowest = Math.min(lowest, xyz[i]);
      highest = Math.max(highest, xyz[i]);
    }
  }
  return {spacing: space.voxel_m, lowest, highest,
          count: shown.reduce((sum, floor) => sum + floor.space.count, 0)};
}

export function readReport(text) {
  const {map, summary} = JSON.parse(text);
  const storey = storeys(map.floors);
  const floors = map.floors.map((floor, index) => ({
    index, label: floor.label, elevation: floor.elevation_m, colour: floor.colour,
    storey: storey[index],
    measured: summary.floors[index].elevation_measured, area: summary.floors[index].area_m2,
    nodes: summary.floors[index].nodes,
    walls: {...floor.walls, xy: column(floor.walls, 'xy_u16')},
    free: {...floor.free, bits: bytesOf(floor.free.bits)},
    space: spaceOf(map.space, index),
  }));
  const nodes = {
    count: map.nodes.count, stamp: column(map.nodes, 'stamp_f64'),
    floor: column(map.nodes, 'floor_u16'), hasScan: column(map.nodes, 'has_scan_u8'),
    ...poses(map.nodes),
  };
  const from = column(map.edges, 'from_i32');
  const to = column(map.edges, 'to_i32');
  const kind = column(map.edges, 'kind_u8');
  const edges = Array.from(from, (_, i) => ({from: from[i], to: to[i], kind: map.edges.kinds[kind[i]]}));
  const scans = {
    count: map.scans.count, step: map.scans.step_m, floor: column(map.scans, 'floor_u16'),
    points: column(map.scans, 'points_u32'), xy: column(map.scans, 'xy_i16'), ...poses(map.scans),
  };
  const trajectory = readTrajectory(map.trajectory);
  const start = trajectory.count ? trajectory.stamp[0] : nodes.count ? nodes.stamp[0] : 0;
  return {
    floors, nodes, edges, scans, trajectory, start, summary,
    space: aboutSpace(map.space, floors),
    attempts: readAttempts(map.attempts, nodes),
    route: map.route ?? null,
    doubts: (summary.doubts ?? []).map((doubt) => (
      {...doubt, floor: Math.max(0, floors.findIndex(({label}) => label === doubt.floor))})),
  };
}
