// References: Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008 (the frame at corners is interpolated and not
//             made orthonormal again, as the bakers of maps do).
// Summary: normal maps of polygons, in the object's space, as Blender's Normal Map node has them.

#part polygons.vert
#include "lib/gradient.glsl"

vec4 bump_texel(int corner, int number) {
  return texelFetch(polygon_bumps, ivec2((corner % CORNERS_PER_ROW) * 2 + number, corner / CORNERS_PER_ROW), 0);
}

void normal_maps_plane(int corner, float slot, vec3 first, vec3 outward, bool is_back) {
  int start = corner / 3 * 3, maps = textureSize(texture_table, 0).y / TABLE_PARTS;
  int row = maps + min(int(slot), maps - 1);
  bump_slot = texelFetch(texture_table, ivec2(0, row), 0).w > 0.0 ? float(row) : -1.0;
  vec3 place = bump_texel(corner, 0).xyz;
  vec2 from = bump_texel(start, 0).xy;
  bump_uv = place.xy;
  bump_signs = vec2(place.z, is_back ? -1.0 : 1.0);
  bump_tangent = bump_texel(corner, 1).xyz;
  bump_normal = corner_texel(corner, 1).xyz;
  gradient_of(start, first, bump_texel(start + 1, 0).xy - from, bump_texel(start + 2, 0).xy - from, bump_u, bump_v);
}

#part polygons.frag
#include "lib/texture_lookup.glsl"
#include "lib/uv_change.glsl"

void normal_maps_bend(inout vec3 normal) {
  if (bump_slot < 0.0 || !(dot(bump_tangent, bump_tangent) > 0.0)) return;
  SurfaceTexture t = surface_texture(int(bump_slot));
  mat2 change = uv_change(bump_u, bump_v, view.window.xy + gl_FragCoord.xy * view.window.zw, depth_at);
  float weights, strength = t.factor.x;
  vec3 bump = 2.0 * texture_sum(t, bump_uv, uv_variances(BUMP_VARIANCE, change), weights).rgb / weights - 1.0;
  bump = vec3(strength * bump.xy, mix(1.0, bump.z, min(strength, 1.0)));
  vec3 across = bump_signs.x * cross(bump_normal, bump_tangent);
  vec3 bent = bump.x * bump_tangent + bump.y * across + bump.z * bump_normal;
  bent = mat3(instance.normal_matrix) * bent * bump_signs.y;
  if (dot(bent, bent) > 0.0) normal = normalize(bent);
}
