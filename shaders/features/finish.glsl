// References: Blender manual, "Principled BSDF".
// Summary: a sample's share of each of the frame's finishes, like those of sets of objects (light_links); shading
//          models mix them by these (lib/finish).

#part splat_varyings
#include "lib/material_place.glsl"
void finish_tell(Splat splat, int index) {
  finish = texelFetch(materials, material_place(index, splat.material) + ivec2(FINISH_TEXEL, 0), 0);
}

#part corner
#include "lib/material_place.glsl"
void finish_tell(int corner, float slot, vec3 eye) {
  finish = texelFetch(materials, material_place(corner, slot) + ivec2(FINISH_TEXEL, 0), 0);
}

#part lit_splats.frag, finishes_differ
#include "lib/material_place.glsl"
void finish_prepare(Splat splat, int index) {
  finish_shares = texelFetch(materials, material_place(index, splat.material) + ivec2(FINISH_TEXEL, 0), 0);
}

#part lit_splats.frag, covered
void finish_emit(inout vec3 emission) {
  emission *= passed_on;
}

#part shaded_sample, covered
void finish_outputs(inout Shaded s) {
  s.outputs.emission *= passed_on;
}

#part gbuffer
void finish_add(inout Fragment f) {
  gbuffer_finish = finish * f.weight;
}

#part polygons.frag
void finish_add() {
  polygon_finish = finish;
}

#part shaded_sample, finishes_differ
void finish_prepare(inout Shaded s) {
  finish_shares = s.mean.weight > 0.0 ? SUM_AT(gbuffer_finish, s.texel, s.tap) / s.mean.weight : vec4(0.0);
}

#part shaded_sample, finishes_differ, polygons
void finish_polygons_prepare(inout Shaded s) {
  finish_shares = mix(finish_shares, SUM_AT(polygon_finish, s.texel, s.tap) / s.mean.sees, s.mean.polygon);
}
