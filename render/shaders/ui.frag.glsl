in vec2 at;
in vec4 tint;

layout(binding = 0) uniform sampler2D font;
layout(location = 0) out vec4 pixel;

void main() { pixel = tint * texture(font, at); }
