// References: Haeberli & Akeley 1990, "The accumulation buffer".
// Summary: the pixel textures of a sample that are added up; of depths, the nearest are kept by another pass.

#part accumulate.frag, combined
void combined_add(ivec2 texel, inout bool is_odd) {
  combined_sum = addable(texelFetch(combined, texel, 0), 1.0, is_odd);
}

#part accumulate.frag, normal_coverage
void normal_coverage_add(ivec2 texel, inout bool is_odd) {
  normal_coverage_sum = addable(texelFetch(normal_coverage, texel, 0), 0.0, is_odd);
}

#part accumulate.frag, diffuse_color
void diffuse_color_add(ivec2 texel, inout bool is_odd) {
  diffuse_color_sum = addable(texelFetch(diffuse_color, texel, 0), 0.0, is_odd);
}

#part accumulate.frag, emission_output
void emission_output_add(ivec2 texel, inout bool is_odd) {
  emission_output_sum = addable(texelFetch(emission_output, texel, 0), 0.0, is_odd);
}

#part accumulate.frag, shadow_overdraw
void shadow_overdraw_add(ivec2 texel, inout bool is_odd) {
  shadow_overdraw_sum = addable(texelFetch(shadow_overdraw, texel, 0), 0.0, is_odd);
}
