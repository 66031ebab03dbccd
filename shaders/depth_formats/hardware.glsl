// References: docs/evidence/numerics.md, which measures both formats.
// Summary: the depth buffer stores hardware depth, affine in 1 / z. It costs nothing and resolves z / near / 2^24,
//          which the plan has found sufficient. Splats are moved back at their corners, which is accurate for small
//          splats.

const float FARTHEST_STORED = 0.9999998;  // 1 means that nothing was drawn

float stored_depth(float depth) {
  vec2 row = vec2(view.projection[2][2], view.projection[3][2]);
  float clip = view.is_parallel > 0.5 ? -row.x * depth + row.y : -row.x + row.y / depth;
  return 0.5 * clip + 0.5;
}

float view_depth(float stored) {
  vec2 row = vec2(view.projection[2][2], view.projection[3][2]);
  float clip = 2.0 * stored - 1.0;
  return view.is_parallel > 0.5 ? (row.y - clip) / row.x : row.y / (clip + row.x);
}

#part moved_back, vertex
// A splat's corner, moved away from the eye by `offset`, but at least by what the depth can resolve.
vec4 splat_corner(vec3 eye, float offset) {
  bool is_orthographic = view.is_parallel > 0.5;
  vec4 unmoved = view.projection * vec4(eye, 1.0);
  offset = max(offset, draw.least_offset * (is_orthographic ? 1.0 : length(eye)));
  eye += offset * (is_orthographic ? vec3(0.0, 0.0, -1.0) : eye / max(length(eye), 1e-30));
  vec4 moved = view.projection * vec4(eye, 1.0);
  // Moving must not push anything beyond the far plane.
  moved.z = min(moved.z, moved.w * max(unmoved.z / unmoved.w, 2.0 * FARTHEST_STORED - 1.0));
  return moved;
}

// A polygon's corner, which may be behind the eye.
vec4 polygon_corner(vec3 eye, float offset) {
  vec4 unmoved = view.projection * vec4(eye, 1.0);
  // Relative to the distance, and limited to it, because the corner may be behind the eye.
  float share = max(min(offset / max(length(eye), 1e-30), 1.0), draw.least_offset);
  eye = view.is_parallel > 0.5 ? eye - vec3(0.0, 0.0, max(offset, draw.least_offset)) : eye * (1.0 + share);
  vec4 moved = view.projection * vec4(eye, 1.0);
  if (unmoved.w > 0.0) moved.z = min(moved.z, moved.w * max(unmoved.z / unmoved.w, 2.0 * FARTHEST_STORED - 1.0));
  return moved;
}
#part moved_back, fragment
void write_moved_depth() {}
#part fragment
void write_depth(float depth) {}
