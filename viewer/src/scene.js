// SPDX-License-Identifier: BSD-3-Clause
// The three-dimensional view. World axes as in the map: x, y in the plane, z up, metres.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';
import {LineSegments2} from 'three/addons/lines/LineSegments2.js';
import {LineSegmentsGeometry} from 'three/addons/lines/LineSegmentsGeometry.js';
import {closureStates} from './states.js';

// Heights above the floor at which things are drawn, so that none hides in another.
const kTrajectoryHeight = 0.1;
const kGraphHeight = 0.25;
const kHighlightHeight = 0.3;
const kPickRadius = 9;  // pixels

const mix = (a, b, t) => a + (b - a) * t;

function cssColour(name) {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  return new THREE.Color(text);
}

/**
 * Line segments whose ends move between two poses. An end is {before, after, from, to, fraction}:
 * places in the plane, and a height between two floors.
 */
class MovingLines {
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

const pointVertex = `
  uniform float pixelsPerMetre;   // at distance 1, or everywhere when the projection is parallel
  uniform float diameter;         // m
  uniform float least;            // px
  void main() {
    vec4 in_eye = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * in_eye;
    gl_PointSize = max(least, diameter * pixelsPerMetre / -in_eye.z);
  }`;

const wallVertex = `
  attribute vec2 foot;
  uniform float wallHeight;
  varying float height;
  void main() {
    height = position.z;
    gl_Position = projectionMatrix * modelViewMatrix *
        vec4(foot, 0.02 + position.z * wallHeight, 1.0);
  }`;
const wallFragment = `
  uniform vec3 colour;
  uniform vec3 footColour;
  uniform float opacity;
  varying float height;
  void main() {
    gl_FragColor = vec4(mix(footColour, colour, height), opacity);
    #include <colorspace_fragment>
  }`;

const scanVertex = `
  attribute float scan;
  uniform sampler2D poses;        // per scan two texels: before, after
  uniform float blend;
  void main() {
    int place = int(scan) * 2;
    int width = textureSize(poses, 0).x;
    vec3 before = texelFetch(poses, ivec2(place % width, place / width), 0).xyz;
    vec3 after = texelFetch(poses, ivec2((place + 1) % width, (place + 1) / width), 0).xyz;
    vec3 pose = mix(before, after, blend);
    float c = cos(pose.z);
    float s = sin(pose.z);
    vec2 point = pose.xy + mat2(c, s, -s, c) * position.xy;
    vec4 in_eye = modelViewMatrix * vec4(point, 0.02, 1.0);
    gl_Position = projectionMatrix * in_eye;
    gl_PointSize = 1.5;
  }`;

const flatFragment = `
  uniform vec3 colour;
  uniform float opacity;
  void main() {
    gl_FragColor = vec4(colour, opacity);
    #include <colorspace_fragment>
  }`;

const nodeFragment = `
  uniform vec3 colour;
  uniform vec3 rim;
  void main() {
    float r = length(gl_PointCoord - 0.5) * 2.0;
    if (r > 1.0) discard;
    gl_FragColor = vec4(r > 0.72 ? rim : colour, 1.0);
    #include <colorspace_fragment>
  }`;

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

    this.measure();
    this.materials = this.makeMaterials();
    this.lines = [];
    this.floorGroups = model.floors.map((floor) => this.makeFloor(floor));
    this.between = new THREE.Group();
    this.scene.add(this.between);
    this.makeLines();
    this.highlight = this.makeHighlight();
    this.applyTheme();
    this.update();

    new ResizeObserver(() => this.resize()).observe(container);
    this.resize();
  }

  // The middle of what is drawn is the scene's origin: a graphics card counts in single precision.
  measure() {
    const box = new THREE.Box2();
    const {floors, nodes} = this.model;
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
    this.origin = box.getCenter(new THREE.Vector2());
    this.size = box.getSize(new THREE.Vector2());
    this.extent = Math.max(this.size.x, this.size.y, 5);
    this.course = this.longAxis();
    const moved = (poses) => {
      for (let i = 0; i < poses.length; i += 3) {
        poses[i] -= this.origin.x;
        poses[i + 1] -= this.origin.y;
      }
    };
    for (const table of [nodes, this.model.trajectory, this.model.scans]) {
      moved(table.before);
      moved(table.after);
    }
  }

  /** Direction of the longer axis of the nodes, rad, so that the first view has it across. */
  longAxis() {
    const {after, count} = this.model.nodes;
    let [xx, xy, yy] = [0, 0, 0];
    for (let i = 0; i < count; ++i) {
      const x = after[3 * i] - this.origin.x;
      const y = after[3 * i + 1] - this.origin.y;
      xx += x * x;
      xy += x * y;
      yy += y * y;
    }
    return Math.atan2(2 * xy, xx - yy) / 2;
  }

  makeMaterials() {
    const line = (width, more) => new LineMaterial({linewidth: width, ...more});
    const materials = {
      trajectory: line(1.4, {transparent: true, opacity: 0.9}),
      odometry: line(1.6),
      floor_change: line(2.4, {dashed: true, dashSize: 0.5, gapSize: 0.35}),
      by_hand: line(2.4),
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
    materials.scan_nodes = node(0.5, 3.6);
    materials.odometry_nodes = node(0.35, 2.6);
    return materials;
  }

  makeFloor(floor) {
    const group = new THREE.Group();
    const parts = {group, floor};
    parts.free = this.makeFree(floor);
    parts.walls = this.makeWalls(floor);
    parts.scans = this.makeScans(floor);
    for (const name of ['scan_nodes', 'odometry_nodes']) {
      parts[name] = this.makeNodes(floor, name === 'scan_nodes');
      parts[name].object.material = this.materials[name];
    }
    group.add(...[parts.free, parts.walls, parts.scans].filter(Boolean),
              parts.scan_nodes.object, parts.odometry_nodes.object);
    this.scene.add(group);
    return parts;
  }

  makeFree({free}) {
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
    plane.position.set(free.origin[0] + width / 2 - this.origin.x,
                       free.origin[1] + height / 2 - this.origin.y, 0);
    return plane;
  }

  makeWalls({walls}) {
    if (!walls.count) return null;
    const feet = new Float32Array(walls.count * 2);
    for (let i = 0; i < walls.count; ++i) {
      feet[2 * i] = walls.origin[0] - this.origin.x + walls.xy[2 * i] * walls.step_m;
      feet[2 * i + 1] = walls.origin[1] - this.origin.y + walls.xy[2 * i + 1] * walls.step_m;
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
  makeScans(floor) {
    const {scans} = this.model;
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

  makeNodes(floor, withScan) {
    const {nodes} = this.model;
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

  nodeEnd(id) {
    const {nodes} = this.model;
    return {
      before: nodes.before.subarray(3 * id, 3 * id + 2), after: nodes.after.subarray(3 * id, 3 * id + 2),
      from: nodes.floor[id], to: nodes.floor[id], fraction: 0,
    };
  }

  makeLines() {
    const {trajectory, edges, attempts, nodes} = this.model;
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
      add(kind === 'closure' ? 'by_hand' : kind, floor, [this.nodeEnd(from), this.nodeEnd(to)]);
    }
    for (const attempt of attempts) {
      add(attempt.state, attempt.floor, [this.nodeEnd(attempt.a), this.nodeEnd(attempt.b)], attempt);
    }
    for (const {layer, floor, ends, items} of sets.values()) {
      const lines = new MovingLines(
          ends, layer === 'trajectory' ? kTrajectoryHeight : kGraphHeight, this.materials[layer]);
      Object.assign(lines, {layer, floor, items});
      lines.object.renderOrder = layer in closureStates ? 2 : 1;
      (floor < 0 ? this.between : this.floorGroups[floor].group).add(lines.object);
      this.lines.push(lines);
    }
  }

  makeHighlight() {
    const highlight = new MovingLines([], kHighlightHeight, this.materials.highlight);
    highlight.object.renderOrder = 4;
    highlight.object.material.depthTest = false;
    this.scene.add(highlight.object);
    return highlight;
  }

  /** Height of a floor as drawn. */
  heightOf(floor) {
    const {elevation, storey} = this.model.floors[floor];
    return elevation + storey * this.separation;
  }

  applyTheme() {
    const background = cssColour('--canvas');
    const dark = background.getHSL({}).l < 0.4;
    this.scene.background = background;
    const shade = (colour, toward, share) => colour.clone().lerp(toward, share);
    for (const {floor, free, walls, scans} of this.floorGroups) {
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
      by_hand: '--by-hand', highlight: '--highlight',
    };
    for (const [state, look] of Object.entries(closureStates)) colours[state] = look.colour;
    for (const [name, variable] of Object.entries(colours)) this.materials[name].color = cssColour(variable);
    for (const [name, variable] of [['scan_nodes', '--node'], ['odometry_nodes', '--odometry']]) {
      this.materials[name].uniforms.colour.value = cssColour(variable);
      this.materials[name].uniforms.rim.value = background;
    }
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
    const ends = [];
    if (item?.attempt) ends.push(this.nodeEnd(item.attempt.a), this.nodeEnd(item.attempt.b));
    if (item && item.node !== undefined) {
      const end = this.nodeEnd(item.node);
      const corner = (dx, dy) => ({
        ...end, before: [end.before[0] + dx, end.before[1] + dy], after: [end.after[0] + dx, end.after[1] + dy],
      });
      const size = 0.6;
      const corners = [corner(size, 0), corner(0, size), corner(-size, 0), corner(0, -size)];
      corners.forEach((c, i) => ends.push(c, corners[(i + 1) % 4]));
    }
    this.highlight = new MovingLines(ends, kHighlightHeight, this.materials.highlight);
    this.highlight.object.renderOrder = 4;
    this.highlight.object.material.depthTest = false;
    this.scene.add(this.highlight.object);
    this.highlight.update(this.blend, (floor) => this.heightOf(floor));
    this.requestRender();
  }

  /** What is drawn nearest to a place of the screen: {node} or {attempt}, or null. */
  pick(clientX, clientY) {
    const frame = this.renderer.domElement.getBoundingClientRect();
    const x = clientX - frame.left;
    const y = clientY - frame.top;
    const {nodes} = this.model;
    const places = new Map();
    const screen = (id) => {
      if (!places.has(id)) {
        const v = this.placeOfNode(id).project(this.camera);
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
    for (const lines of this.lines) {
      if (!lines.items.length || !lines.object.visible || !this.floorShown[lines.floor]) continue;
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
      if (!this.floorShown[nodes.floor[id]]) continue;
      if (!this.shows(nodes.hasScan[id] ? 'scan_nodes' : 'odometry_nodes')) continue;
      const place = screen(id);
      if (place) offer(Math.hypot(place[0] - x, place[1] - y), {node: id});
    }
    return best;
  }

  onKey(event) {
    const turn = 0.08;
    const offset = this.camera.position.clone().sub(this.controls.target);
    const spherical = new THREE.Spherical().setFromVector3(
        new THREE.Vector3(offset.x, offset.z, -offset.y));
    const put = () => {
      const turned = new THREE.Vector3().setFromSpherical(spherical);
      this.camera.position.copy(this.controls.target)
          .add(new THREE.Vector3(turned.x, -turned.z, turned.y));
    };
    const move = (right, forward) => {
      const step = offset.length() * 0.06;
      const heading = new THREE.Vector3(-offset.x, -offset.y, 0);
      if (heading.lengthSq() < 1e-9) heading.set(0, 1, 0);
      heading.normalize();
      const way = new THREE.Vector3(heading.y, -heading.x, 0).multiplyScalar(right * step)
          .addScaledVector(heading, forward * step);
      this.controls.target.add(way);
      this.camera.position.add(way);
    };
    const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
    if (event.ctrlKey || event.metaKey || event.altKey) return;
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
      this.look();
    } else {
      return;
    }
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
    this.materials.scan_nodes.uniforms.pixelsPerMetre.value = pixelsPerMetre;
    this.materials.odometry_nodes.uniforms.pixelsPerMetre.value = pixelsPerMetre;
    this.renderer.render(this.scene, this.camera);
    this.onrender(pixelsPerMetre / this.renderer.getPixelRatio() / distance);
  }
}
