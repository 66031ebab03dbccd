// References: Botsch et al. 2005, section 4 (deferred shading: attributes are blended, not colours).
// Summary: each splat's corner, its colour, its shading normal turned to the viewer, and what its side weighs.

#include "common/octahedron.glsl"
#include "common/sides.glsl"
#include "common/splat_fetch.glsl"
#include "methods/{method}.glsl"

void main() {
  ivec2 texel = splat_texel(gl_VertexID >> 2);
  vec2 corner = quad_corner(gl_VertexID);
  vec4 position_data = texelFetch(surfels, texel, 0);
  vec4 u_data = texelFetch(surfels, texel + ivec2(1, 0), 0);
  vec4 v_data = texelFetch(surfels, texel + ivec2(2, 0), 0);
  mat3 linear = mat3(splats.model_view);
  vec3 position = (splats.model_view * vec4(position_data.xyz, 1.0)).xyz;
  vec3 axis_u = linear * u_data.xyz;
  vec3 axis_v = linear * v_data.xyz;
  vec3 eye = footprint_corner(position, axis_u, axis_v, corner);
  place_depth = vec3(corner, -eye.z);
  float cosine = outward_cosine(position, axis_u, axis_v, splats.sides.x, splats.options.z > 0.5);
  color_weight = vec4(texelFetch(surfels, texel + ivec2(3, 0), 0).rgb, cosine < 0.0 ? BACK_WEIGHT : 1.0);
  normal = normalize(mat3(splats.normal_matrix) * octahedral_decode(vec2(position_data.w, u_data.w)));
  float side = cosine < -GRAZING_COSINE ? -splats.sides.x : splats.sides.x;
  if (dot(normal, cross(axis_u, axis_v)) * side < 0.0) normal = -normal;
#ifdef MATERIAL_TARGET
  material = texelFetch(materials, ivec2(min(int(v_data.w), textureSize(materials, 0).x - 1), 0), 0).xyz;
#endif
  gl_Position = cosine < 0.0 && splats.sides.y > 0.5 ? NOWHERE : splats.projection * vec4(eye, 1.0);
}
