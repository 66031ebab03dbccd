// References: none needed.
// Summary: the depth along the view, 0 at the nearest and 1 at the farthest visible depth of the plan.

vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  vec2 range = frame.depth_range;
  return vec3(clamp((-position.z - range.x) / (range.y - range.x), 0.0, 1.0));
}
