// References: none needed.
// Summary: counts the splats that a sample averages, in a sum of its own or beside the planes of shadows.

#part gbuffer, by_itself
void overdraw_add(inout Fragment f) {
  gbuffer_overdraw = 1.0;
}

#part gbuffer, beside_planes
void overdraw_add(inout Fragment f) {
  gbuffer_plane.zw = vec2(1.0, f.lift * f.weight);
}

#part shaded_sample, by_itself
void overdraw_outputs(inout Shaded s) {
  s.outputs.shadow_overdraw.a = SUM_AT(gbuffer_overdraw, s.texel, s.tap).r;
}

#part shaded_sample, beside_planes
void overdraw_outputs(inout Shaded s) {
  s.outputs.shadow_overdraw.a = SUM_AT(gbuffer_plane, s.texel, s.tap).z;
}

#part shaded_sample, overdraw_model
void overdraw_model_prepare(inout Shaded s) {
  overdraw = SUM_AT(gbuffer_overdraw, s.texel, s.tap).r;
}
