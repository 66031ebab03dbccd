// References: Botsch, Kobbelt 2003, section 3.1 (the size of a splat is that of its bounding sphere on the axis).
// Summary: for methods in which the nearest splat wins: a triangle around each sprite, parallel to the picture, at the
//          depth of the splat's centre; backs are moved behind the fronts in their place.

#include "lib/instances/{instances}.glsl"
#include "lib/nowhere.glsl"
#include "hosts/splat.glsl"
#include "hosts/splat_varyings.glsl"
#include "depth_formats/{depth_format}.glsl"
#include "methods/{method}.glsl"

void main() {
  int vertex = begun_vertex();
  int index = drawn_splat(vertex / 3);
  Splat splat = fetch_splat(index);
  float radius = sqrt(max(dot(splat.axis_u, splat.axis_u), dot(splat.axis_v, splat.axis_v)));
  float depth = -splat.position.z, scale = view.is_parallel > 0.5 ? 1.0 : 1.0 / depth;
  vec2 tilt = sprite_tilt(splat.axis_u, splat.axis_v);
  place = disc_in_sprite(tilt, triangle_corner(vertex));
  tilt_depth = vec3(tilt, depth);
  color_weight = vec4(splat.color, splat.side_weight);
  normal = splat.normal;
  hand_on(splat, index);
  vec4 clip = view.projection * vec4((splat.position.xy + radius * place) * scale, -1.0, 1.0);
  float behind = splat.side_weight < 1.0 ? BACK_EPSILON * draw.epsilon * radius : 0.0;
  bool is_before = !(depth >= view.near);
  float stored = min(2.0 * stored_depth(depth + behind) - 1.0, 1.0);
  gl_Position = splat.is_hidden || is_before ? nowhere(splat.position) : vec4(clip.xy / clip.w, stored, 1.0);
}
