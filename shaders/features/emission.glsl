// References: Blender manual, "Principled BSDF", Emission.
// Summary: emitted light: constant, or one value per surfel.

#part splat_varyings, gbuffer_emission
#include "lib/material_place.glsl"
void emission_tell(Splat splat, int index) {
  emission = texelFetch(materials, material_place(index, splat.material) + ivec2(1, 0), 0).xyz;
}

#part corner, gbuffer_emission
#include "lib/material_place.glsl"
void emission_tell(int corner, float slot, vec3 eye) {
  emission = texelFetch(materials, material_place(corner, slot) + ivec2(1, 0), 0).xyz;
}

#part lit_splats.frag, gbuffer_emission
#include "lib/material_place.glsl"
void emission_prepare(Splat splat, int index) {
  emission = texelFetch(materials, material_place(index, splat.material) + ivec2(1, 0), 0).xyz;
}

#part lit_splats.frag, shared_emission
void emission_prepare(Splat splat, int index) {
  emission = frame.emission.rgb;
}

#part gbuffer, gbuffer_emission
void emission_add(inout Fragment f) {
  gbuffer_emission = vec4(emission, 1.0) * f.weight;
}

#part polygons.frag, gbuffer_emission
void emission_add() {
  polygon_emission = vec4(emission, 1.0);
}

#part shaded_sample, gbuffer_emission
void emission_outputs(inout Shaded s) {
  vec4 e = SUM_AT(gbuffer_emission, s.texel, s.tap);
  // Uses its own weights, because those of float16 sums are scaled.
  s.outputs.emission = e.w > 0.0 ? e.rgb / e.w : vec3(0.0);
}

#part shaded_sample, gbuffer_emission, polygons
void emission_polygons_outputs(inout Shaded s) {
  vec3 of_polygon = SUM_AT(polygon_emission, s.texel, s.tap).rgb / s.mean.sees;
  s.outputs.emission = mix(s.outputs.emission, of_polygon, s.mean.polygon);
}

#part shaded_sample, shared_emission
void emission_outputs(inout Shaded s) {
  s.outputs.emission = frame.emission.rgb;
}
