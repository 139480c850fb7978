// One triangle that covers the picture.
out vec2 v_screen;  // −1 … 1

void main() {
  v_screen = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);
  gl_Position = vec4(v_screen, 1, 1);  // at the far plane
}
