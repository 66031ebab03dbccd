// References: Botsch et al. 2005, section 4 (deferred shading: attributes are blended, not colours).
// Summary: for methods that draw quads in space: each splat's corner and its attributes.

#define VERTEX_STAGE
#define PARALLEL (splats.options.z > 0.5)
#include "common/nowhere.glsl"
#include "common/splat_attributes.glsl"
#ifdef WITH_MATERIALS
#include "common/splat_material.glsl"
#endif
#include "methods/{method}.glsl"
#ifdef TEXTURED
#include "common/splat_texture.glsl"
#endif

void main() {
  Splat splat = fetch_splat(gl_VertexID / 3);
  vec2 corner = triangle_corner(gl_VertexID);
  vec3 eye = footprint_corner(splat.position, splat.axis_u, splat.axis_v, corner);
  place_depth = vec3(corner, -eye.z);
  color_weight = splat.color_weight;
  normal = splat.normal;
#ifdef LAYER
  opacity = splat.opacity;
#endif
#ifdef REST
  int number = gl_VertexID / 3;
  color_weight = vec4(texelFetch(lit_splats, ivec2(number % SPLATS_PER_ROW, number / SPLATS_PER_ROW), 0).rgb, 1.0);
#endif
#ifdef TEXTURED
  texture_place = fetch_texture_place(gl_VertexID / 3, splat.material, texture_along, texture_border);
  texture_axis_u = splat.axis_u;
  texture_axis_v = splat.axis_v;
#endif
#ifdef WITH_MATERIALS
  fetch_material(gl_VertexID / 3, splat.material);
#endif
  gl_Position = splat.is_hidden ? NOWHERE : splats.projection * vec4(eye, 1.0);
}
