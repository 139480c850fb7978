// Put before every shader: what all of them know about the studio.
layout(std140, binding = 0) uniform Studio {
  mat4 view_projection;
  mat4 key_matrix;    // world to shadow map, 0 … 1
  mat4 dome_matrix;
  vec4 eye;           // xyz [m]
  vec4 key;           // xyz: unit, towards the light; w: size of a shadow texel [m]
  vec4 dome;          // xyz: unit, towards this sample of the sky; w: texel [m], 0: no sample
  vec4 ground;        // height, centre x, centre z, radius of the scene [m]
  vec4 ray_centre;    // viewing ray of the picture's point (x, y) in −1 … 1:
  vec4 ray_right;     // centre + x right + y up
  vec4 ray_up;
  vec4 options;       // x: view, y: largest strain, z: shadow taps, w: tap radius [texels]
};

const int kViewWireframe = 1, kViewStrain = 2;

const vec3 kKeyColour = vec3(1.00, 0.955, 0.90) * 1.22;
const vec3 kSkyColour = vec3(0.90, 0.95, 1.03) * 0.36;
const vec3 kFloorBounce = vec3(0.98, 0.95, 0.92) * 0.14;
const vec3 kFillColour = vec3(1.0) * 0.05;  // from the camera, so that no side is black
const vec3 kRimColour = vec3(0.92, 0.96, 1.0) * 0.55;  // from behind, to set folds off
const vec3 kRim = vec3(0.592, 0.423, -0.686);
