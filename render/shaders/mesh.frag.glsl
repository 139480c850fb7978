in vec3 v_position;
in vec3 v_normal;
in vec2 v_thread;
in vec3 v_corner;
flat in float v_strain;

uniform int is_fabric;
uniform vec3 front_colour;
uniform vec3 back_colour;

out vec4 colour;

const float kPi = 3.14159265;

// Diffuse light that wraps around the terminator as in a fuzzy surface; keeps the energy.
float wrapped(float facing, float wrap) {
  return max(0.0, facing + wrap) / ((1.0 + wrap) * (1.0 + wrap));
}

// Sheen of short fibres: Estevez and Kulla 2017 ("Production friendly microfacet sheen"), with the
// visibility of Neubelt and Pettineo 2013.
float sheen(float n_h, float n_l, float n_v) {
#ifdef DRAFT
  float d = (1.0 - n_h * n_h) * (4.2 / (2.0 * kPi));
#else
  const float inverse_roughness = 1.0 / 0.45;
  float d = (2.0 + inverse_roughness) * pow(max(1e-4, 1.0 - n_h * n_h), 0.5 * inverse_roughness) /
            (2.0 * kPi);
#endif
  return d / (4.0 * (n_l + n_v - n_l * n_v) + 1e-3);
}

float hash(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }

// Slow noise along one direction of threads: yarn is never quite even.
float slub(float across, float along) {
  float row = floor(across), f = smoothstep(0.0, 1.0, fract(along)), column = floor(along);
  return mix(hash(vec2(row, column)), hash(vec2(row, column + 1.0)), f);
}

// How much of a pattern is left when a pixel covers so many of its threads: it fades out before it
// could flicker.
float visible(vec2 threads) {
  vec2 footprint = fwidth(threads);
  return 1.0 - smoothstep(0.3, 0.75, max(footprint.x, footprint.y));
}

// Brightness of a plain weave: single threads 1.2 mm wide from near, uneven yarn from afar.
float weave() {
  vec2 t = v_thread / 0.0012, far = v_thread / 0.0045;
  float over = mod(floor(t.x) + floor(t.y), 2.0);
  vec2 c = fract(t) - 0.5;
  float across = over > 0.5 ? c.x : c.y, along = over > 0.5 ? c.y : c.x;
  float thread = 1.12 - 1.5 * across * across - 0.7 * along * along;
  float yarn = 0.5 * (slub(far.x, far.y / 14.0) + slub(far.y + 77.0, far.x / 14.0));
  return mix(1.0, thread, visible(t)) * (1.0 + 0.16 * visible(far) * (yarn - 0.5));
}

vec3 fabric(vec3 p, vec3 n, vec3 v, vec3 albedo) {
  const float kWrap = 0.16;
  float n_l = dot(n, key.xyz), n_v = max(dot(n, v), 0.02);
  float lit = key_light(p, n);
  vec3 diffuse = kKeyColour * lit * wrapped(n_l, kWrap);
  // Light from behind comes through the threads, coloured by them.
  vec3 through = kKeyColour * lit * 0.30 * wrapped(-n_l, kWrap) * albedo;
  vec3 around = sky_light(p, n) + kFloorBounce * (0.5 - 0.5 * n.y) + kFillColour * n_v;
  float grazing = (1.0 - n_v) * (1.0 - n_v);
  vec3 h = normalize(key.xyz + v);
  float n_l_up = max(n_l, 0.0);
  vec3 fibre = mix(vec3(0.7), albedo, 0.65) *
               (kKeyColour * lit * 0.8 * n_l_up * sheen(max(dot(n, h), 0.0), n_l_up, n_v) +
                around * 0.35 * grazing * (1.0 - n_v) +
                kRimColour * grazing * max(dot(n, kRim), 0.0));
  return albedo * (diffuse + through + around) + fibre;
}

vec3 body(vec3 p, vec3 n, vec3 v, vec3 albedo) {
  float n_l = dot(n, key.xyz);
  vec3 diffuse = kKeyColour * wrapped(n_l, 0.1);
  if (n_l > -0.1) diffuse *= key_light(p, n);
  float n_v = max(dot(n, v), 0.0);
  vec3 around = sky_light(p, n) + kFloorBounce * (0.5 - 0.5 * n.y) + kFillColour * n_v +
                kRimColour * 0.5 * (1.0 - n_v) * (1.0 - n_v) * max(dot(n, kRim), 0.0);
  return albedo * (diffuse + around);
}

// Slate, teal, green, yellow, red: ends differ in lightness too.
// The colours of legend.cpp.
vec3 scale_colour(float s) {
  const vec3 stops[5] = vec3[](vec3(0.09, 0.13, 0.30), vec3(0.05, 0.34, 0.46), vec3(0.25, 0.58, 0.26),
                               vec3(0.93, 0.71, 0.10), vec3(0.80, 0.07, 0.04));
  float x = clamp(s, 0.0, 1.0) * 4.0;
  int i = min(int(x), 3);
  return mix(stops[i], stops[i + 1], x - float(i));
}

// 1 on the edges of the mesh, a line 1.1 samples wide.
float edge_line() {
  vec3 d = v_corner / max(fwidth(v_corner), vec3(1e-6));
  return 1.0 - smoothstep(0.5, 1.4, min(d.x, min(d.y, d.z)));
}

void main() {
  vec3 v = normalize(eye.xyz - v_position);
  vec3 n = normalize(v_normal);
  int view = int(options.x);
  if (!gl_FrontFacing) n = -n;
  vec3 albedo = is_fabric != 0 && !gl_FrontFacing ? back_colour : front_colour;
  if (is_fabric != 0) {
    if (view == kViewStrain) albedo = scale_colour(v_strain / options.y);
#ifndef DRAFT
    else albedo *= weave();
#endif
    if (view == kViewWireframe) albedo = mix(albedo, 0.12 * albedo, edge_line());
    colour = vec4(fabric(v_position, n, v, albedo), 1);
  } else {
    if (view == kViewWireframe) albedo *= mix(1.0, 0.75, edge_line());
    colour = vec4(body(v_position, n, v, albedo), 1);
  }
}
