// References: as plane.glsl.
// Summary: maps a line of a splat's plane, (direction, c) with direction . q + c >= 0 in half-axes, to the picture.

#include "lib/plane.glsl"

// Returns (direction, c) in pixels, of arbitrary length. Beyond the plane's horizon its sides continue.
vec3 line_in_picture(vec3 line, Plane plane) {
  vec2 a = plane.a, b = plane.b;
  vec3 seen = vec3(line.x * b.y - line.y * a.y - line.z * plane.det.x, line.y * a.x - line.x * b.x - line.z * plane.det.y,
                   line.z * plane.det.z);
  seen.z -= dot(seen.xy, plane.center);
  bool is_none = line.xy == vec2(0.0);
  return is_none ? line : plane.det.z < 0.0 ? -seen : seen;
}
