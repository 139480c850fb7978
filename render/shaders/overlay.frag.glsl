in vec4 v_tint;

uniform float opacity;  // below 1 for what shows through the cloth

out vec4 colour;

void main() { colour = vec4(v_tint.rgb, v_tint.a * opacity); }
