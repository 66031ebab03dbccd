// References: none needed.
// Summary: the material of a splat: of its slot, or its own where textures drive it; the twin of pack_materials and
//          pack_own_materials in rendering/packing.py.

#ifdef EMISSION_TARGET
const int TEXELS_PER_MATERIAL = 2;
#else
const int TEXELS_PER_MATERIAL = 1;
#endif

void fetch_material(int index, float slot) {
  bool is_own = texelFetch(materials, ivec2(0), 0).w > 0.5;
  ivec2 place = is_own ? ivec2(index % SPLATS_PER_ROW, index / SPLATS_PER_ROW)
                       : ivec2(min(int(slot), textureSize(materials, 0).x / TEXELS_PER_MATERIAL - 1), 0);
  place.x *= TEXELS_PER_MATERIAL;
#ifdef MATERIAL_TARGET
  material = texelFetch(materials, place, 0).xyz;
#endif
#ifdef EMISSION_TARGET
  emission = texelFetch(materials, place + ivec2(1, 0), 0).xyz;
#endif
}
