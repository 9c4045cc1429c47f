// SPDX-License-Identifier: BSD-3-Clause
// Lines between places that move from before the optimisation to after it.
import {LineSegments2} from 'three/addons/lines/LineSegments2.js';
import {LineSegmentsGeometry} from 'three/addons/lines/LineSegmentsGeometry.js';

export const mix = (a, b, t) => a + (b - a) * t;

/**
 * Line segments whose ends move between two poses. An end is {before, after, from, to, fraction}:
 * places in the plane, and a height between two floors.
 */
export class MovingLines {
  constructor(ends, height, material) {
    this.ends = ends;
    this.height = height;
    this.places = new Float32Array(ends.length * 3);
    this.geometry = new LineSegmentsGeometry();
    this.geometry.setPositions(this.places);
    this.object = new LineSegments2(this.geometry, material);
    this.object.frustumCulled = false;
  }
  update(blend, heightOf) {
    const target = this.geometry.attributes.instanceStart.data;
    for (let i = 0; i < this.ends.length; ++i) {
      const end = this.ends[i];
      target.array[3 * i] = mix(end.before[0], end.after[0], blend);
      target.array[3 * i + 1] = mix(end.before[1], end.after[1], blend);
      target.array[3 * i + 2] =
          mix(heightOf(end.from), heightOf(end.to), end.fraction) + this.height;
    }
    target.needsUpdate = true;
  }
  dispose() { this.geometry.dispose(); }
}
