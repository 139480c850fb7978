// Adds one sample of the picture to the sum.
layout(binding = 2) uniform sampler2D sample_map;

uniform float weight;

out vec4 colour;

void main() { colour = weight * texelFetch(sample_map, ivec2(gl_FragCoord.xy), 0); }
