// SPDX-License-Identifier: BSD-3-Clause
// The three-dimensional view. World axes as in the map: x, y in the plane, z up, metres.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {centre} from './extent.js';
import {makeFloor} from './floor_parts.js';
import {kGraphHeight, makeHighlight, makeLines} from './graph_lines.js';
import {followKey} from './keys.js';
import {applyColours, makeMaterials} from './materials.js';
import {mix} from './moving_lines.js';
import {pick} from './picking.js';

export class MapScene {
  constructor(container, model) {
    this.container = container;
    this.model = model;
    this.separation = 0;
    this.wallHeight = 0;
    this.blend = 1;
    this.layers = {};
    this.floorShown = model.floors.map(() => true);
    this.onrender = () => {};

    this.renderer = new THREE.WebGLRenderer({antialias: true});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    container.append(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.5, 5000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.maxPolarAngle = Math.PI / 2;
    this.controls.zoomToCursor = true;
    this.controls.screenSpacePanning = false;
    this.controls.addEventListener('change', () => this.requestRender());
    container.addEventListener('keydown', (event) => this.onKey(event));

    Object.assign(this, centre(model));
    this.materials = makeMaterials(model.space);
    this.floorGroups = model.floors.map((floor) => makeFloor(floor, model, this.origin, this.materials));
    this.between = new THREE.Group();
    this.scene.add(...this.floorGroups.map(({group}) => group), this.between);
    this.lines = makeLines(model, this.materials);
    for (const {floor, object} of this.lines) {
      (floor < 0 ? this.between : this.floorGroups[floor].group).add(object);
    }
    this.highlight = makeHighlight(null, model.nodes, this.materials.highlight);
    this.scene.add(this.highlight.object);
    this.applyTheme();
    this.update();

    new ResizeObserver(() => this.resize()).observe(container);
    this.resize();
  }

  /** Height of a floor as drawn. */
  heightOf(floor) {
    const {elevation, storey} = this.model.floors[floor];
    return elevation + storey * this.separation;
  }

  applyTheme() {
    this.scene.background = applyColours(this.materials, this.floorGroups);
    this.requestRender();
  }

  /** Everything to its place, for the blend and the separation in force. */
  update() {
    const {nodes} = this.model;
    const optimised = this.blend === 1;
    for (const parts of this.floorGroups) {
      const shown = this.floorShown[parts.floor.index];
      parts.group.visible = shown;
      parts.group.position.z = this.heightOf(parts.floor.index);
      if (parts.free) parts.free.visible = this.shows('free') && optimised;
      if (parts.walls) {
        parts.walls.visible = this.shows('walls') && optimised;
        parts.walls.userData.columns.visible = this.wallHeight > 0;
        parts.walls.userData.columns.material.uniforms.wallHeight.value = this.wallHeight;
      }
      if (parts.scans) {
        parts.scans.visible = this.shows('walls') && !optimised;
        parts.scans.material.uniforms.blend.value = this.blend;
      }
      if (parts.space) parts.space.visible = this.shows('space') && optimised;
      for (const name of ['scan_nodes', 'odometry_nodes']) {
        const {ids, object} = parts[name];
        object.visible = this.shows(name);
        const places = object.geometry.attributes.position;
        ids.forEach((id, i) => places.setXYZ(
            i, mix(nodes.before[3 * id], nodes.after[3 * id], this.blend),
            mix(nodes.before[3 * id + 1], nodes.after[3 * id + 1], this.blend), kGraphHeight));
        places.needsUpdate = true;
      }
    }
    for (const lines of this.lines) {
      lines.object.visible = this.shows(lines.layer);
      lines.update(this.blend, lines.floor < 0 ? (floor) => this.heightOf(floor) : () => 0);
      if (lines.layer === 'floor_change') lines.object.computeLineDistances();
    }
    this.between.visible = this.floorShown.some(Boolean);
    this.highlight.update(this.blend, (floor) => this.heightOf(floor));
    this.requestRender();
  }

  shows(layer) { return this.layers[layer] ?? true; }

  setFloor(floor, shown) {
    this.floorShown[floor] = shown;
    this.update();
  }
  setLayer(layer, shown) {
    this.layers[layer] = shown;
    this.update();
  }
  setSeparation(metres) {
    // The view stays on what it was on: half-way up the building.
    const before = this.middle();
    this.separation = metres;
    const rise = this.middle() - before;
    this.controls.target.z += rise;
    this.camera.position.z += rise;
    this.update();
    this.controls.update();
  }
  setWallHeight(metres) {
    this.wallHeight = metres;
    this.update();
  }
  /** Points of space are shown between two heights above their floors, m. */
  setBand(low, high) {
    this.materials.space.uniforms.band.value.set(low, high);
    this.requestRender();
  }
  setBlend(blend) {
    this.blend = blend;
    this.update();
  }

  middle() {
    const heights = this.model.floors.map((floor) => this.heightOf(floor.index));
    return heights.length ? (Math.min(...heights) + Math.max(...heights)) / 2 : 0;
  }

  /** Places that a view of the whole has to hold: nodes and some walls of every floor, as drawn. */
  * places() {
    const {nodes, floors} = this.model;
    for (let i = 0; i < nodes.count; ++i) yield this.placeOfNode(i);
    for (const {index, walls} of floors) {
      const stride = Math.ceil(walls.count / 2000);
      for (let i = 0; i < walls.count; i += stride) {
        yield new THREE.Vector3(walls.origin[0] - this.origin.x + walls.xy[2 * i] * walls.step_m,
                                walls.origin[1] - this.origin.y + walls.xy[2 * i + 1] * walls.step_m,
                                this.heightOf(index));
      }
    }
  }

  /** Looks at all of the building: 'top', 'side' or 'oblique'. */
  look(from = 'oblique') {
    const target = new THREE.Vector3(0, 0, this.middle());
    const directions = {
      // Not quite from above: there, the way up of the screen would be undefined.
      top: new THREE.Vector3(0, -0.0005, 1), side: new THREE.Vector3(0, -1, 0.02),
      oblique: new THREE.Vector3(-0.25, -0.8, 0.8),
    };
    const direction = directions[from].applyAxisAngle(new THREE.Vector3(0, 0, 1), this.course).normalize();
    this.controls.target.copy(target);
    this.camera.position.copy(target).add(direction);
    this.camera.lookAt(target);
    // The smallest distance from which all of it is in sight.
    const tan = Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2)) * 0.92;
    const right = new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 0);
    const up = new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, 1);
    let distance = 3;
    for (const place of this.places()) {
      place.sub(target);
      const nearer = place.dot(direction);
      distance = Math.max(distance, nearer + Math.abs(place.dot(up)) / tan,
                          nearer + Math.abs(place.dot(right)) / (tan * this.camera.aspect));
    }
    this.camera.position.copy(target).addScaledVector(direction, distance);
    this.controls.maxDistance = distance * 6;
    this.controls.minDistance = 0.5;
    this.controls.update();
    this.requestRender();
  }

  placeOfNode(id) {
    const {nodes} = this.model;
    return new THREE.Vector3(
        mix(nodes.before[3 * id], nodes.after[3 * id], this.blend),
        mix(nodes.before[3 * id + 1], nodes.after[3 * id + 1], this.blend),
        this.heightOf(nodes.floor[id]) + kGraphHeight);
  }

  /** Moves the view to an item without turning it. */
  goTo(item) {
    const middle = item.attempt
        ? this.placeOfNode(item.attempt.a).add(this.placeOfNode(item.attempt.b)).multiplyScalar(0.5)
        : this.placeOfNode(item.node);
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.setLength(Math.min(offset.length(), Math.max(25, this.extent / 4)));
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).add(offset);
    this.controls.update();
    this.requestRender();
  }

  select(item) {
    this.scene.remove(this.highlight.object);
    this.highlight.dispose();
    this.highlight = makeHighlight(item, this.model.nodes, this.materials.highlight);
    this.scene.add(this.highlight.object);
    this.highlight.update(this.blend, (floor) => this.heightOf(floor));
    this.requestRender();
  }

  /** What is drawn nearest to a place of the screen: {node} or {attempt}, or null. */
  pick(clientX, clientY) { return pick(this, clientX, clientY); }

  onKey(event) {
    if (!followKey(this, event)) return;
    event.preventDefault();
    this.controls.update();
    this.requestRender();
  }

  resize() {
    const {clientWidth, clientHeight} = this.container;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  requestRender() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => this.render());
  }

  render() {
    this.waiting = false;
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(0.05, distance / 400);
    this.camera.far = distance * 4 + this.extent * 4;
    this.camera.updateProjectionMatrix();
    const size = this.renderer.getDrawingBufferSize(new THREE.Vector2());
    const pixelsPerMetre = size.y / 2 / Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2));
    for (const {walls} of this.floorGroups) {
      if (walls) walls.userData.points.material.uniforms.pixelsPerMetre.value = pixelsPerMetre;
    }
    if (this.materials.space) this.materials.space.uniforms.pixelsPerMetre.value = pixelsPerMetre;
    this.materials.scan_nodes.uniforms.pixelsPerMetre.value = pixelsPerMetre;
    this.materials.odometry_nodes.uniforms.pixelsPerMetre.value = pixelsPerMetre;
    this.renderer.render(this.scene, this.camera);
    this.onrender(pixelsPerMetre / this.renderer.getPixelRatio() / distance);
  }
}
