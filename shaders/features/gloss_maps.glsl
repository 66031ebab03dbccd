// References: none needed.
// Summary: images of the roughness and metallic of polygons.

#part polygons.vert, seen_gloss
#include "lib/gradient.glsl"

vec2 gloss_place(int corner) {
  return texelFetch(polygon_glosses, ivec2(corner % CORNERS_PER_ROW, corner / CORNERS_PER_ROW), 0).xy;
}

void gloss_maps_plane(int corner, float slot, vec3 first, vec3 outward, bool is_back) {
  int start = corner / 3 * 3, maps = textureSize(texture_table, 0).y / TABLE_PARTS;
  int row = 2 * maps + min(int(slot), maps - 1);
  gloss_slot = texelFetch(texture_table, ivec2(0, row), 0).w > 0.0 ? float(row) : -1.0;
  gloss_uv = gloss_place(corner);
  vec2 from = gloss_place(start);
  gradient_of(start, first, gloss_place(start + 1) - from, gloss_place(start + 2) - from, gloss_u, gloss_v);
}

#part polygons.frag, seen_gloss
#include "lib/texture_lookup.glsl"
#include "lib/uv_change.glsl"

void gloss_maps_looked_up(inout vec3 own) {
  if (gloss_slot < 0.0) return;
  SurfaceTexture t = surface_texture(int(gloss_slot));
  mat2 change = uv_change(gloss_u, gloss_v, view.window.xy + gl_FragCoord.xy * view.window.zw, depth_at);
  float weights;
  vec2 found = texture_sum(t, gloss_uv, uv_variances(GLOSS_VARIANCE, change), weights).rg / weights;
  found = clamp(found * t.factor.xy, 0.0, 1.0);
  own.xy = vec2(t.factor.x < 0.0 ? own.x : found.x, t.factor.y < 0.0 ? own.y : found.y);
}
