// References: none needed.
// Summary: how many splats a sample is the mean of.

#part gbuffer
void overdraw_add(inout Fragment f) {
  gbuffer_overdraw = 1.0;
}

#part shaded_sample
void overdraw_outputs(inout Shaded s) {
  s.outputs.shadow_overdraw.a = SUM_AT(gbuffer_overdraw, s.texel, s.tap).r;
}

#part shaded_sample, overdraw_model
void overdraw_model_attributes(inout Shaded s) {
  overdraw = SUM_AT(gbuffer_overdraw, s.texel, s.tap).r;
}
