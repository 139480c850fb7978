// The floor catches the scene's shadow: a factor for the backdrop behind it.
in vec3 v_position;
in float v_away;

out vec4 colour;

void main() {
  const vec3 up = vec3(0, 1, 0);
  vec3 key_open = kKeyColour * key.y;
  vec3 sky = kSkyColour;
  if (dome.w != 0.0) sky *= 2.0 * dome.y * dome_light(v_position, up);
  vec3 share = (key_open * key_light(v_position, up) + sky) / (key_open + kSkyColour);
  colour = vec4(mix(share, vec3(1), max(0.22, smoothstep(0.9, 2.05, v_away))), 1);
}
