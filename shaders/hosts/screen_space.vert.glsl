// References: Botsch et al. 2005, section 4; Guennebaud et al. 2006, section 3.2 (the bounds of a splat).
// Summary: for screen-space methods: a triangle around the splat's footprint, and its attributes. Hooks: `clip` before
//          the method adjusts the splat, `clipped` afterwards, `place` for splats not drawn in the picture; `replaced`
//          if the method has replaced axes, `reach` for splats that nearer ones may not hide, `cull` for splats that
//          need not be drawn.

#include "lib/instances/{instances}.glsl"
#include "lib/nowhere.glsl"
#include "hosts/splat.glsl"
#include "hosts/splat_varyings.glsl"
#include "depth_formats/{depth_format}.glsl"
#include "lib/plane.glsl"
#include "methods/{method}.glsl"

// The fragment shader decides where a splat ends, not the hardware's rounding of a triangle's corners.
const float MARGIN = 1.01;

#parts
void main() {
  int vertex = begun_vertex();
  int index = drawn_splat(vertex / 3);
  Splat splat = fetch_splat(index);
  vec2 corner = triangle_corner(vertex);
  bool is_orthographic = view.is_parallel > 0.5, in_space = false;
  #hook clip(splat, in_space)
  Plane true_plane = splat_plane(splat.position, splat.axis_u, splat.axis_v, is_orthographic), plane = true_plane;
  if (!in_space) adjust(splat, plane, is_orthographic);
  plane_ab = vec4(plane.a, plane.b);
  plane_center_gh = vec4(plane.center, plane.gh);
  plane_depths = vec4(plane.slope, plane.depth, plane.reach);
  plane_det_radius = vec4(plane.det, plane.radius);
  footprint_map = vec3(0.0);
  footprint_middle = vec2(0.0);
  #hook clipped(splat, in_space)
  color_weight = vec4(splat.color, splat.side_weight * splat.amplitude);
  normal = splat.normal;
  hand_on(splat, index);
  #hook replaced(true_plane, plane, in_space)
  gl_Position = nowhere(splat.position);
  #hook place(splat, corner, in_space)
  if (!splat.is_hidden && !in_space) {
    vec2 size, middle;
    mat2 axes = projected_ellipse(plane, size, middle);
    vec2 half_axes = footprint(plane, size, middle);
    mat2 across = mat2(axes[0] / half_axes.x, axes[1] / half_axes.y) * transpose(axes);
    footprint_map = vec3(across[0], across[1].y);
    footprint_middle = middle - plane.center;
    // Stretched along the picture's axes instead of rotated to the ellipse's, whose direction depends on rounding for
    // circles. The corner is beside the splat, not above: surfaces at grazing angles change fastest upwards.
    vec2 pixels = axes * (half_axes * (MARGIN * corner.yx * axes));
    bool is_culled = false;
    #hook cull(plane, middle, axes, half_axes, is_culled)
    vec4 clip = view.projection * vec4(view.window.xy + (middle + pixels) * view.window.zw, -1.0, 1.0);
    float nearest = nearest_depth(plane);
    #hook reach(plane, nearest)
    nearest = clamp(2.0 * stored_depth(nearest) - 1.0, -1.0, 1.0);
    if (!is_culled) gl_Position = vec4(clip.xy / clip.w, nearest, 1.0);
  }
}
