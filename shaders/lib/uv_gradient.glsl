// References: none needed.
// Summary: texture coordinates of polygons' corners, and their change in a triangle's plane.

#include "lib/corner_uv.glsl"
#include "lib/gradient.glsl"

// Row of a material slot in the table of textures; -1 without a texture.
float texture_slot_of(float slot) {
  int row = min(int(slot), textureSize(texture_table, 0).y / TABLE_PARTS - 1);
  return texelFetch(texture_table, ivec2(0, row), 0).w > 0.0 ? float(row) : -1.0;
}

// Change of the texture coordinates along each axis of view space, in the triangle's plane. start: its first corner.
void uv_gradient(int start, vec3 first, out vec3 along_u, out vec3 along_v) {
  vec2 uv = corner_uv(start);
  gradient_of(start, first, corner_uv(start + 1) - uv, corner_uv(start + 2) - uv, along_u, along_v);
}
