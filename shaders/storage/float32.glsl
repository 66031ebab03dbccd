// References: rendering/upload/packing.py, which writes this layout.
// Summary: four texels of float32 per splat, 512 splats per row.

#include "lib/octahedron.glsl"

StoredSplat stored_splat(int index) {
  ivec2 texel = ivec2((index % SPLATS_PER_ROW) * TEXELS_PER_SPLAT, index / SPLATS_PER_ROW);
  vec4 position_data = texelFetch(surfels, texel, 0);
  vec4 u_data = texelFetch(surfels, texel + ivec2(1, 0), 0);
  vec4 v_data = texelFetch(surfels, texel + ivec2(2, 0), 0);
  vec4 color = texelFetch(surfels, texel + ivec2(3, 0), 0);
  vec3 normal = octahedral_decode(vec2(position_data.w, u_data.w));
  return StoredSplat(position_data.xyz, u_data.xyz, v_data.xyz, normal, v_data.w, color);
}

#part hidden_backs
bool take_hidden_back(inout StoredSplat stored, int index) {
  bool is_hidden = stored.color.a > 1.5;
  if (is_hidden) stored.color.a -= 2.0;
  return is_hidden;
}

#part blend_depth
// The share of the radius over which a splat blends; the integer part is the material's number.
float take_blend_depth(inout StoredSplat stored, int index) {
  float whole = floor(stored.material), left_out = stored.material - whole;
  stored.material = whole;
  return 1.0 - left_out;
}
