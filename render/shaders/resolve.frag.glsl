// Light to picture: box filter over the samples of a pixel, highlights rolled off, sRGB. No dither.
layout(binding = 2) uniform sampler2D sample_map;

uniform int side;  // samples along one side of a pixel

out vec4 colour;

// Colours stay what they are up to the shoulder; only highlights are pressed together.
vec3 roll_off(vec3 x) {
  const float kShoulder = 0.7;
  vec3 over = max(x - kShoulder, 0.0) / (1.0 - kShoulder);
  return min(x, kShoulder) + (1.0 - kShoulder) * (1.0 - exp(-over));
}

vec3 srgb(vec3 x) {
  return mix(12.92 * x, 1.055 * pow(max(x, 1e-6), vec3(1.0 / 2.4)) - 0.055,
             greaterThan(x, vec3(0.0031308)));
}

void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy) * side;
  vec3 sum = vec3(0);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      sum += roll_off(texelFetch(sample_map, corner + ivec2(x, y), 0).rgb);
  colour = vec4(srgb(sum / float(side * side)), 1);
}
