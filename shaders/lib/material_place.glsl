// References: none needed.
// Summary: where the material of a splat or a corner is stored: that of its slot, or its own if textures drive it. The
//          twin of pack_materials and pack_own_materials in rendering/upload/packing.py.

ivec2 material_place(int index, float slot) {
  bool is_own = texelFetch(materials, ivec2(0), 0).w > 0.5;
  ivec2 place = is_own ? ivec2(index % SPLATS_PER_ROW, index / SPLATS_PER_ROW)
                       : ivec2(min(int(slot), textureSize(materials, 0).x / TEXELS_PER_MATERIAL - 1), 0);
  place.x *= TEXELS_PER_MATERIAL;
  return place;
}
