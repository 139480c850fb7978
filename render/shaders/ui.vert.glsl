// The user interface: window pixels from the top left corner.
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 font_position;
layout(location = 2) in vec4 colour;

uniform vec3 corner, size;

out vec2 at;
out vec4 tint;

void main() {
  vec2 unit = (position - corner.xy) / size.xy;
  at = font_position;
  tint = colour;
  gl_Position = vec4(2 * unit.x - 1, 1 - 2 * unit.y, 0, 1);
}
