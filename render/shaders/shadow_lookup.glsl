// Share of the light that gets to a point, from depth maps.
layout(binding = 0) uniform sampler2DShadow key_map;
layout(binding = 1) uniform sampler2DShadow dome_map;

const float kDomeRadius = 4.0;  // [texels]

// Points on a disc, evenly by area along a golden spiral.
vec2 disc_point(int i, int n) {
  float r = sqrt((float(i) + 0.5) / float(n)), angle = 2.39996323 * float(i);
  return r * vec2(cos(angle), sin(angle));
}

// The point is moved off the surface on the side that looks to the light, so that neither side of
// a thin cloth shadows itself.
vec3 off_surface(vec3 p, vec3 n, vec3 towards, float texel) {
  float facing = dot(n, towards);
  return p + texel * (facing >= 0.0 ? 1.0 : -1.0) * (1.6 - abs(facing)) * n + 0.8 * texel * towards;
}

float key_light(vec3 p, vec3 n) {
  vec4 q = key_matrix * vec4(off_surface(p, n, key.xyz, key.w * max(1.0, 0.6 * options.w)), 1);
  if (any(lessThan(q.xy, vec2(0))) || any(greaterThan(q.xy, vec2(1)))) return 1.0;
  q.z = clamp(q.z, 0.0, 1.0);
#ifdef DRAFT
  return textureLod(key_map, q.xyz, 0.0);
#else
  int taps = int(options.z);
  float texel = 1.0 / float(textureSize(key_map, 0).x), sum = 0.0;
  for (int i = 0; i < taps; ++i)
    sum += textureLod(key_map, vec3(q.xy + options.w * texel * disc_point(i, taps), q.z), 0.0);
  return sum / float(taps);
#endif
}

float dome_light(vec3 p, vec3 n) {
  vec4 q = dome_matrix * vec4(off_surface(p, n, dome.xyz, dome.w * 0.5 * kDomeRadius), 1);
  if (any(lessThan(q.xy, vec2(0))) || any(greaterThan(q.xy, vec2(1)))) return 1.0;
  // Blurred, so that a few dozen samples of the sky do not show as separate shadows.
  const int kTaps = 4;
  float texel = 1.0 / float(textureSize(dome_map, 0).x), sum = 0.0;
  for (int i = 0; i < kTaps; ++i) {
    vec2 at = q.xy + kDomeRadius * texel * disc_point(i, kTaps);
    sum += textureLod(dome_map, vec3(at, clamp(q.z, 0.0, 1.0)), 0.0);
  }
  return sum / float(kTaps);
}

// Light of the sky on a surface: this sample of it, or all of it with nothing in the way.
vec3 sky_light(vec3 p, vec3 n) {
  if (dome.w == 0.0) return kSkyColour * (0.5 + 0.5 * n.y) * 0.82;
  float facing = dot(n, dome.xyz);
  return facing <= 0.0 ? vec3(0) : kSkyColour * (2.0 * facing * dome_light(p, n));
}
