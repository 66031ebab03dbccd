// References: none needed.
// Summary: how many splats a sample is the mean of.

#part gbuffer
void overdraw_add(inout Fragment f) {
  overdraw_sum = 1.0;
}

#part shaded_sample
void overdraw_outputs(inout Shaded s) {
  s.outputs.shadow_overdraw.a = SUM_AT(overdraw_sum, s.texel, s.tap).r;
}

#part shaded_sample, overdraw_model
void overdraw_model_attributes(inout Shaded s) {
  overdraw = SUM_AT(overdraw_sum, s.texel, s.tap).r;
}
