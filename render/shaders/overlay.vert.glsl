layout(location = 0) in vec3 position;
layout(location = 1) in vec4 tint;

out vec4 v_tint;

void main() {
  v_tint = tint;
  gl_Position = view_projection * vec4(position, 1);
}
