// References: Botsch et al. 2005, section 4 (deferred shading: attributes are blended, not colours).
// Summary: for methods that draw quads in space: the corner and attributes of each splat.

#include "lib/instances/{instances}.glsl"
#include "lib/nowhere.glsl"
#include "hosts/splat.glsl"
#include "hosts/splat_varyings.glsl"
#include "methods/{method}.glsl"

#parts
void main() {
  int vertex = begun_vertex();
  int index = drawn_splat(vertex / 3);
  Splat splat = fetch_splat(index);
  vec2 corner = triangle_corner(vertex);
  mat2 widened = widen(splat);
  vec3 eye = footprint_corner(splat.position, splat.axis_u, splat.axis_v, corner);
  place_depth = vec3(corner, -eye.z);
  color_weight = vec4(splat.color, splat.side_weight * splat.amplitude);
  normal = splat.normal;
  hand_on(splat, index);
  #hook axes(splat, widened)
  gl_Position = splat.is_hidden ? nowhere(splat.position) : quad_corner(splat, eye);
}
