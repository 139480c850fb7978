// A paper backdrop that runs into the floor without an edge: the same colour everywhere, and near
// the scene the floor catches its shadow.
in vec2 v_screen;

out vec4 colour;

vec3 paper() {
  vec3 low = vec3(0.66, 0.655, 0.65), high = vec3(0.80, 0.81, 0.825);
  float vignette = 1.0 - 0.10 * dot(v_screen * vec2(0.8, 0.6), v_screen * vec2(0.8, 0.6));
  return mix(low, high, smoothstep(-1.1, 0.9, v_screen.y)) * vignette;
}

void main() {
  vec3 base = paper();
  colour = vec4(base, 1);
  vec3 ray = ray_centre.xyz + v_screen.x * ray_right.xyz + v_screen.y * ray_up.xyz;
  float t = (ground.x - eye.y) / ray.y;
  if (ray.y >= 0.0 || t <= 0.0) return;
  vec3 p = eye.xyz + t * ray;
  float away = length(p.xz - ground.yz) / ground.w;
  float near = 1.0 - smoothstep(1.2, 3.6, away);
  if (near <= 0.0) return;
  const vec3 up = vec3(0, 1, 0);
  const vec3 sky_open = dome.w == 0.0 ? kSkyColour : kSkyColour * 2.0 * dome.y;
  vec3 key_open = kKeyColour * key.y;
  vec3 sky = dome.w == 0.0 ? sky_open : sky_open * dome_light(p, up);
  vec3 whole = key_open + kSkyColour;  // what the paper gets in the open, averaged over the samples
  vec3 got = key_open * key_light(p, up) + sky;
  colour.rgb = base * mix(vec3(1), got / whole, near);
}
