// References: Botsch, Kobbelt 2003, section 3.3 (epsilon is added to the depth) and equation 4 (the depth at each pixel).
// Summary: visibility for sprites uses the same sprites, so that both passes have the same shape and depth.

#part visibility.vert
#include "lib/plane.glsl"
#include "lib/reaches_near.glsl"
#include "methods/{method}.glsl"

void sprite_visibility_shape(Splat splat, vec2 corner, float offset, inout vec4 moved) {
  if (reaches_near(splat)) return;
  vec2 tilt = sprite_tilt(splat.axis_u, splat.axis_v), place = disc_in_sprite(tilt, corner);
  float radius = sqrt(max(dot(splat.axis_u, splat.axis_u), dot(splat.axis_v, splat.axis_v)));
  moved = splat_corner(splat.position + vec3(HALF_SIDE * radius * place, 0.0), offset);
  across_offset = vec3(0.0, 0.0, offset);
  // Linear in the picture, because the sprite is parallel to it.
  place_depth.z = sprite_depth(-splat.position.z, radius, dot(tilt, place));
}
