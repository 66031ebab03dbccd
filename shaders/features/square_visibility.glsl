// References: Botsch et al. 2005, section 3 (each splat is drawn as a square with the size of its bounding sphere on the axis).
// Summary: as printed, a splat hides only what lies behind it in that square. The least size of section 5 is that of the
//          attribute pass alone.

#part visibility.vert
#include "lib/reaches_near.glsl"

// Centre and half of the side, in pixels; splats that reach the near plane are drawn in space, whole.
void square_visibility_shape(Splat splat, vec2 corner, float offset, inout vec4 moved) {
  float scale = view.is_parallel > 0.5 ? 1.0 : 1.0 / -splat.position.z;
  float radius = sqrt(max(dot(splat.axis_u, splat.axis_u), dot(splat.axis_v, splat.axis_v)));
  float half_side = reaches_near(splat) ? 3e38 : radius * scale / min(view.window.z, view.window.w);
  square = vec3((splat.position.xy * scale - view.window.xy) / view.window.zw, half_side);
}
#part visibility.frag
void square_visibility_keep() {
  vec2 from_center = abs(gl_FragCoord.xy - square.xy);
  if (max(from_center.x, from_center.y) > square.z) discard;
}
