// Light to picture: box filter over the samples of a pixel, highlights rolled off, sRGB. No dither.
layout(binding = 2) uniform sampler2D sample_map;

uniform int side;  // samples along one side of a pixel

out vec4 colour;

// Colours stay what they are up to the shoulder; only highlights are pressed together.
vec3 roll_off(vec3 x) {
  const float kShoulder = 0.7;
  vec3 over = max(x - kShoulder, 0.0);
  return min(x, kShoulder) + over * (1.0 - kShoulder) / (1.0 - kShoulder + over);
}

// sRGB's curve fitted with roots, within 0.1/255: a power costs more, and rounds differently on
// every processor.
vec3 srgb(vec3 x) {
  vec3 root = sqrt(x);
  vec3 curve = -0.07690 + 0.83374 * root + 0.29812 * sqrt(root) - 0.05531 * x;
  return mix(12.92 * x, curve, greaterThan(x, vec3(0.0031308)));
}

void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy) * side;
  vec3 sum = vec3(0);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      sum += roll_off(texelFetch(sample_map, corner + ivec2(x, y), 0).rgb);
  colour = vec4(srgb(sum / float(side * side)), 1);
}
