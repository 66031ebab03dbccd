// References: Guennebaud et al. 2006, section 5.1 (polygons are drawn into textures of their own).
// Summary: corners of polygons and their attributes, the normal on the side that is seen.

#define VERTEX_STAGE
#include "common/nowhere.glsl"
#include "polygons/corner.glsl"
#ifdef IDENTITY_TARGET
#include "common/identity.glsl"
#endif
#ifdef WITH_MATERIALS
#include "common/splat_material.glsl"
#endif

#ifdef TEXTURED
// What the texture coordinates change along each axis of view space, in the triangle's plane.
void texture_gradient(int start, vec3 first, vec3 outward) {
  vec3 along = corner_position(start + 1) - first, beside = corner_position(start + 2) - first;
  vec2 uv = texelFetch(polygon_uvs, ivec2(start % SPLATS_PER_ROW, start / SPLATS_PER_ROW), 0).xy;
  vec2 to_along = texelFetch(polygon_uvs, ivec2((start + 1) % SPLATS_PER_ROW, (start + 1) / SPLATS_PER_ROW), 0).xy - uv;
  vec2 to_beside = texelFetch(polygon_uvs, ivec2((start + 2) % SPLATS_PER_ROW, (start + 2) / SPLATS_PER_ROW), 0).xy - uv;
  vec3 plane = cross(along, beside);
  float square = max(dot(plane, plane), 1e-37);
  vec3 dual_along = cross(beside, plane) / square, dual_beside = cross(plane, along) / square;
  gradient_u = to_along.x * dual_along + to_beside.x * dual_beside;
  gradient_v = to_along.y * dual_along + to_beside.y * dual_beside;
}
#endif

void main() {
  vec3 eye = corner_position(gl_VertexID), first;
  vec3 outward = triangle_normal(gl_VertexID, first);
  bool is_back = shows_back(outward, first);
#ifdef PLANE
  triangle_plane = outward / max(length(outward), 1e-30) * (is_back ? -1.0 : 1.0);
#endif
  vec4 place = corner_texel(gl_VertexID, 0);
  depth_at = -eye.z;
#ifdef SPLIT
  split_place = eye;
#endif
  corner_normal = normalize(mat3(splats.normal_matrix) * corner_texel(gl_VertexID, 1).xyz) * (is_back ? -1.0 : 1.0);
  corner_color = corner_texel(gl_VertexID, 2).rgb;
#ifdef IDENTITY_TARGET
  number = splat_number(place.w);
#endif
#ifdef WITH_MATERIALS
  fetch_material(gl_VertexID, place.w);
#endif
#ifdef TEXTURED
  int slot = min(int(place.w), textureSize(texture_table, 0).y - 1);
  texture_slot = texelFetch(texture_table, ivec2(0, slot), 0).w > 0.0 ? float(slot) : -1.0;
  texture_uv = texelFetch(polygon_uvs, ivec2(gl_VertexID % SPLATS_PER_ROW, gl_VertexID / SPLATS_PER_ROW), 0).xy;
  texture_gradient(gl_VertexID / 3 * 3, first, outward);
#endif
  gl_Position = is_back && splats.sides.y > 0.5 ? NOWHERE : splats.projection * vec4(eye, 1.0);
}
