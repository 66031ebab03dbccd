// References: Botsch et al. 2005, section 4.
// Summary: roughness, metallic and reflectance that vary between surfels.

#part splat_varyings
#include "lib/material_place.glsl"
void materials_tell(Splat splat, int index) {
  material = texelFetch(materials, material_place(index, splat.material), 0).xyz;
}

#part corner
#include "lib/material_place.glsl"
void materials_tell(int corner, float slot, vec3 eye) {
  material = texelFetch(materials, material_place(corner, slot), 0).xyz;
}

#part lit_splats.frag
#include "lib/material_place.glsl"
void materials_prepare(Splat splat, int index) {
  material = texelFetch(materials, material_place(index, splat.material), 0).xyz;
}

#part gbuffer
void materials_add(inout Fragment f) {
  gbuffer_material = vec4(material, 1.0) * f.weight;
}

#part shaded_sample
void materials_prepare(inout Shaded s) {
  s.material = s.mean.weight > 0.0 ? SUM_AT(gbuffer_material, s.texel, s.tap).xyz / s.mean.weight : vec3(0.0);
}

#part shaded_sample, polygons
void materials_polygons_prepare(inout Shaded s) {
  s.material = mix(s.material, SUM_AT(polygon_material, s.texel, s.tap).xyz / s.mean.sees, s.mean.polygon);
}
