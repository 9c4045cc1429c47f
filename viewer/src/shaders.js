// SPDX-License-Identifier: BSD-3-Clause
// What the graphics card does with points and walls.
export const pointVertex = `
  uniform float pixelsPerMetre;   // at distance 1, or everywhere when the projection is parallel
  uniform float diameter;         // m
  uniform float least;            // px
  void main() {
    vec4 in_eye = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * in_eye;
    gl_PointSize = max(least, diameter * pixelsPerMetre / -in_eye.z);
  }`;

export const wallVertex = `
  attribute vec2 foot;
  uniform float wallHeight;
  varying float height;
  void main() {
    height = position.z;
    gl_Position = projectionMatrix * modelViewMatrix *
        vec4(foot, 0.02 + position.z * wallHeight, 1.0);
  }`;
export const wallFragment = `
  uniform vec3 colour;
  uniform vec3 footColour;
  uniform float opacity;
  varying float height;
  void main() {
    gl_FragColor = vec4(mix(footColour, colour, height), opacity);
    #include <colorspace_fragment>
  }`;

export const scanVertex = `
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

// Points of space by their height above the floor: those outside a band are nowhere.
export const spaceVertex = `
  uniform float pixelsPerMetre;
  uniform float diameter;
  uniform vec2 band;              // m
  uniform vec2 reach;             // m, of all
  varying float share;
  void main() {
    share = clamp((position.z - reach.x) / max(reach.y - reach.x, 0.01), 0.0, 1.0);
    vec4 in_eye = modelViewMatrix * vec4(position, 1.0);
    bool is_shown = position.z >= band.x && position.z <= band.y;
    gl_Position = is_shown ? projectionMatrix * in_eye : vec4(2.0, 2.0, 2.0, 1.0);
    gl_PointSize = max(1.3, diameter * pixelsPerMetre / -in_eye.z);
  }`;
export const spaceFragment = `
  uniform vec3 lowColour;
  uniform vec3 highColour;
  varying float share;
  void main() {
    gl_FragColor = vec4(mix(lowColour, highColour, share), 1.0);
    #include <colorspace_fragment>
  }`;

export const flatFragment = `
  uniform vec3 colour;
  uniform float opacity;
  void main() {
    gl_FragColor = vec4(colour, opacity);
    #include <colorspace_fragment>
  }`;

export const nodeFragment = `
  uniform vec3 colour;
  uniform vec3 rim;
  void main() {
    float r = length(gl_PointCoord - 0.5) * 2.0;
    if (r > 1.0) discard;
    gl_FragColor = vec4(r > 0.72 ? rim : colour, 1.0);
    #include <colorspace_fragment>
  }`;
