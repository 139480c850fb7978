// One run a face corner: fetching by hand gives every face its own strain, thread coordinates and
// edge distances, from buffers that are shared by all passes.
layout(std430, binding = 0) readonly buffer Positions { float position[]; };
layout(std430, binding = 1) readonly buffer Normals { float normal[]; };
layout(std430, binding = 2) readonly buffer Faces { int face_vertex[]; };
layout(std430, binding = 3) readonly buffer Inverses { vec4 face_inverse[]; };
layout(std430, binding = 4) readonly buffer Threads { vec2 corner_thread[]; };

uniform int is_fabric;

out vec3 v_position;
out vec3 v_normal;
out vec2 v_thread;
out vec3 v_corner;
flat out float v_strain;

vec3 fetch_position(int v) { return vec3(position[3 * v], position[3 * v + 1], position[3 * v + 2]); }
vec3 fetch_normal(int v) { return vec3(normal[3 * v], normal[3 * v + 1], normal[3 * v + 2]); }

// Largest principal stretch − 1 of the map from material space (2 × 2) to the face in space.
float largest_strain(vec3 e1, vec3 e2, vec4 inverse) {
  vec3 weft = inverse.x * e1 + inverse.z * e2;
  vec3 warp = inverse.y * e1 + inverse.w * e2;
  float a = dot(weft, weft), b = dot(weft, warp), c = dot(warp, warp);
  float largest = 0.5 * (a + c) + sqrt(0.25 * (a - c) * (a - c) + b * b);
  return sqrt(max(largest, 0.0)) - 1.0;
}

void main() {
  int face = gl_VertexID / 3, corner = gl_VertexID % 3;
  int vertex = face_vertex[gl_VertexID];
  v_position = fetch_position(vertex);
  v_normal = fetch_normal(vertex);
  v_corner = vec3(corner == 0, corner == 1, corner == 2);
  v_thread = vec2(0);
  v_strain = 0;

  vec3 p0 = fetch_position(face_vertex[3 * face]);
  vec3 e1 = fetch_position(face_vertex[3 * face + 1]) - p0;
  vec3 e2 = fetch_position(face_vertex[3 * face + 2]) - p0;
  if (is_fabric != 0) {
    v_thread = corner_thread[gl_VertexID];
    v_strain = largest_strain(e1, e2, face_inverse[face]);
  } else {
    // Bodies with sharp edges (boxes) keep them: a normal far from the face's is not smoothed.
    vec3 flat_normal = cross(e1, e2);
    float size = length(flat_normal);
    if (size > 0 && dot(v_normal, flat_normal) < 0.8 * size) v_normal = flat_normal / size;
  }
  gl_Position = view_projection * vec4(v_position, 1);
}
