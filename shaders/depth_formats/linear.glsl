// References: docs/evidence/numerics.md, which measures both formats.
// Summary: the depth buffer stores depth / far, which float32 resolves to 2^-24 of z at any distance. Fragments write
//          it and are moved back individually.

const float FARTHEST_STORED = 0.9999998;  // 1 means that nothing was drawn

float stored_depth(float depth) {
  return depth * view.depth_unit;
}

float view_depth(float stored) {
  return stored / view.depth_unit;
}

#part moved_back, vertex
vec4 splat_corner(vec3 eye, float offset) {
  across_offset = vec3(view.is_parallel > 0.5 ? vec2(0.0) : eye.xy, offset);
  return view.projection * vec4(eye, 1.0);
}

vec4 polygon_corner(vec3 eye, float offset) {
  return splat_corner(eye, offset);
}
#part fragment
void write_depth(float depth) {
  gl_FragDepth = min(depth * view.depth_unit, FARTHEST_STORED);
}
#part moved_back, fragment
void write_moved_depth() {
  float distance = length(vec3(across_offset.xy, place_depth.z));
  write_depth(place_depth.z * (1.0 + max(across_offset.z / distance, draw.least_offset)));
}
