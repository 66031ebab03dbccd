// References: as visibility.vert.glsl.
// Summary: depth, and whose it is where that is asked for; what lies outside the ellipse, or before the near plane (where
//          only the offset brought it into view), leaves none. Of a transparent layer, neither does what is in a nearer
//          one or behind what is opaque.

#include "common/depth.glsl"
#ifdef SPLIT_POLYGONS
#include "common/split.glsl"
#endif
#ifdef LAYER
#include "common/layer_sample.glsl"
#endif
#ifdef SCREEN_DOOR
#include "common/screen_door.glsl"
#endif

void main() {
  if (!(dot(place_depth.xy, place_depth.xy) <= 1.0 && place_depth.z >= splats.options.y)) discard;
#ifdef SPLIT_POLYGONS
  if (splats.identity.z > 0.0 && split_distance(split_place) > splats.identity.z) discard;
#endif
#ifdef SCREEN_DOOR
  if (!is_kept(opacity_surface.x, int(opacity_surface.y + 0.5), ivec2(gl_FragCoord.xy))) discard;
#endif
#ifdef LAYER
  if (!is_in_layer(place_depth.z, 0.0, ivec2(gl_FragCoord.xy))) discard;
#endif
#ifdef LINEAR_DEPTH
  float distance = length(vec3(across_offset.xy, place_depth.z));
  write_depth(place_depth.z * (1.0 + max(across_offset.z / distance, splats.sides.z)));
#endif
#ifdef IDENTITY_TARGET
  identity = vec2(number, place_depth.z);
#endif
}
