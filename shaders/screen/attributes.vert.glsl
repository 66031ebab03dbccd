// References: Botsch et al. 2005, section 4; Guennebaud et al. 2006, section 3.3 (the exact bounds of a splat).
// Summary: for methods that work in the picture: a triangle around the splat's footprint, and its attributes.
//          A splat that reaches the near plane is drawn in space instead, which the hardware clips.

#define VERTEX_STAGE
#define PROJECTION splats.projection
#define PARALLEL (splats.options.z > 0.5)
#define DEPTH_UNIT splats.options.w
#ifdef IDENTITY_TARGET
#include "common/identity.glsl"
#endif
#include "common/nowhere.glsl"
#include "common/splat_attributes.glsl"
#ifdef WITH_MATERIALS
#include "common/splat_material.glsl"
#endif
#include "common/stored_depth.glsl"
#include "screen/plane.glsl"
#ifdef CULLS_HIDDEN
#include "screen/culling.glsl"
#endif
#include "methods/{method}.glsl"
#ifdef TEXTURED
#include "common/splat_texture.glsl"
#endif

const float STRADDLING_MARGIN = 1.02;
// What is drawn ends where the fragment shader says, not where the hardware rounds a triangle's corners to.
const float MARGIN = 1.01;

void main() {
  Splat splat = fetch_splat(gl_VertexID / 3);
  vec2 corner = triangle_corner(gl_VertexID);
  bool is_orthographic = splats.options.z > 0.5;
#ifdef STRADDLING
  bool straddles = -splat.position.z - length(vec2(splat.axis_u.z, splat.axis_v.z)) <= splats.options.y;
#else
  const bool straddles = false;
#endif
  Plane true_plane = splat_plane(splat.position, splat.axis_u, splat.axis_v, is_orthographic), plane = true_plane;
  if (!straddles) adjust(splat, plane, is_orthographic);
#ifdef STRADDLING
  straddles = -splat.position.z - length(vec2(splat.axis_u.z, splat.axis_v.z)) <= splats.options.y;
  straddling = straddles ? 1.0 : 0.0;
#endif
  // The first three varyings carry the plane of a splat before the eye, or centre and half-axes of a straddling one.
  plane_ab = straddles ? vec4(splat.position, 0.0) : vec4(plane.a, plane.b);
  plane_center_gh = straddles ? vec4(splat.axis_u, 0.0) : vec4(plane.center, plane.gh);
  plane_depths = straddles ? vec4(splat.axis_v, 0.0) : vec4(plane.slope, plane.depth, plane.reach);
  plane_det_radius = straddles ? vec4(0.0) : vec4(plane.det, plane.radius);
  footprint_map = vec3(0.0);
  footprint_middle = vec2(0.0);
  color_weight = splat.color_weight;
  normal = splat.normal;
#ifdef IDENTITY_TARGET
  number = splat_number(splat.material);
#endif
#ifdef LAYER
  opacity = splat.opacity;
#endif
#ifdef REST
  int number = gl_VertexID / 3;
  color_weight = vec4(texelFetch(lit_splats, ivec2(number % SPLATS_PER_ROW, number / SPLATS_PER_ROW), 0).rgb, 1.0);
#endif
#ifdef TEXTURED
  texture_place = fetch_texture_place(gl_VertexID / 3, splat.material, texture_along, texture_border);
  // Axes that the method replaced move in the picture as others of the true plane do.
  if (true_plane.a != plane.a || true_plane.b != plane.b) {
    mat2 to_true = inverse(mat2(true_plane.a, true_plane.b)) * mat2(plane.a, plane.b);
    mat2 along = mat2(texture_along.xy, texture_along.zw) * to_true;
    texture_along = vec4(along[0], along[1]);
    texture_border = texture_border * to_true;
  }
#endif
#ifdef WITH_MATERIALS
  fetch_material(gl_VertexID / 3, splat.material);
#endif
  if (splat.is_hidden) {
    gl_Position = NOWHERE;
  }
  else if (straddles) {
    vec2 grown = corner * STRADDLING_MARGIN;
    gl_Position = splats.projection * vec4(splat.position + splat.axis_u * grown.x + splat.axis_v * grown.y, 1.0);
  }
  else {
    vec2 size, middle;
    mat2 axes = projected_ellipse(plane, size, middle);
    vec2 half_axes = footprint(plane, size, middle);
    mat2 across = mat2(axes[0] / half_axes.x, axes[1] / half_axes.y) * transpose(axes);
    footprint_map = vec3(across[0], across[1].y);
    footprint_middle = middle - plane.center;
    // Stretched along the axes, not turned to them: what they are of a circle, or which way they point, is rounding's.
    // The corner is beside the splat, not above: surfaces that are seen flat change fastest upwards.
    vec2 pixels = axes * (half_axes * (MARGIN * corner.yx * axes));
    vec4 clip = splats.projection * vec4(splats.window.xy + (middle + pixels) * splats.window.zw, -1.0, 1.0);
    gl_Position = vec4(clip.xy / clip.w, clamp(2.0 * stored_depth(nearest_depth(plane)) - 1.0, -1.0, 1.0), 1.0);
#ifdef CULLS_HIDDEN
    mat2 along = mat2(axes[0] * half_axes.x, axes[1] * half_axes.y);
    vec2 reach = FOOTPRINT_END * vec2(length(vec2(along[0].x, along[1].x)), length(vec2(along[0].y, along[1].y)));
    if (is_behind_all(middle, reach, plane.depth - plane.reach)) gl_Position = NOWHERE;
#endif
  }
}
