// A disc on the floor around the scene, as a fan.
const int kCorners = 64;
const float kReach = 2.1;  // radii of the scene

out vec3 v_position;
out float v_away;  // from the centre, in radii

void main() {
  float angle = 6.2831853 * float(gl_VertexID - 1) / float(kCorners);
  v_away = gl_VertexID == 0 ? 0.0 : kReach;
  vec2 p = ground.yz + v_away * ground.w * vec2(cos(angle), -sin(angle));
  v_position = vec3(p.x, ground.x, p.y);
  gl_Position = view_projection * vec4(v_position, 1);
}
