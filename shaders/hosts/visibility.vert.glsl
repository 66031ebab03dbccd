// References: Botsch, Hornung, Zwicker, Kobbelt, "High-Quality Surface Splatting on Today's GPUs", 2005, section 4.1
//             (visibility splatting); the view-independent paper, section 5 (the offset along the view ray).
// Summary: every splat is moved away from the eye by its own epsilon, so that everything within epsilon blends, and at
//          least by what the depth can resolve, or rounding would let a splat hide itself. Hooks: `blend` reduces the
//          depth, `move` uses another length, `shape` changes the shape from the exact ellipse.

#include "lib/instances/{instances}.glsl"
#include "depth_formats/{depth_format}.glsl"
#include "lib/nowhere.glsl"
#include "hosts/splat.glsl"
#include "hosts/splat_varyings.glsl"
#include "methods/quad.glsl"

#parts
void main() {
  int vertex = begun_vertex();
  int index = drawn_splat(vertex / 3);
  Splat splat = fetch_splat(index);
  vec2 corner = triangle_corner(vertex);
  vec3 eye = footprint_corner(splat.position, splat.axis_u, splat.axis_v, corner);
  place_depth = vec3(corner, -eye.z);
  hand_on(splat, index);
  float radius = splat.grain * sqrt(max(dot(splat.axis_u, splat.axis_u), dot(splat.axis_v, splat.axis_v)));
  float offset = draw.epsilon * radius;
  if (splat.is_back) offset *= BACK_EPSILON;
  offset += draw.epsilon_length;
  #hook blend(splat, eye, offset)
  #hook move(splat, radius, offset)
  vec4 moved = splat_corner(eye, offset);
  #hook shape(splat, corner, offset, moved)
  gl_Position = splat.is_hidden ? nowhere(splat.position) : moved;
}
