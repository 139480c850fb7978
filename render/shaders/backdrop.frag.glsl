// A paper backdrop; it runs into the floor without an edge because both have one colour.
in vec2 v_screen;

out vec4 colour;

void main() {
  const vec3 low = vec3(0.66, 0.655, 0.65), high = vec3(0.80, 0.81, 0.825);
  float vignette = 1.0 - 0.064 * v_screen.x * v_screen.x - 0.036 * v_screen.y * v_screen.y;
  colour = vec4(mix(low, high, smoothstep(-1.1, 0.9, v_screen.y)) * vignette, 1);
}
