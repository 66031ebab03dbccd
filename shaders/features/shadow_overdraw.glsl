// References: Blender manual, "Passes".
// Summary: outputs the share of the lights that is not shadowed, and the number of splats.

#part outputs
void shadow_overdraw_write(Outputs values) {
  out_shadow_overdraw = values.shadow_overdraw;
}

#part sample_outputs
void shadow_overdraw_read(inout Outputs values, ivec2 texel) {
  values.shadow_overdraw = texelFetch(sample_shadow_overdraw, texel, 0);
}

#part before_layers, layers_shadow_overdraw
void shadow_overdraw_hand(ivec2 pixel, inout Outputs outputs) {
  outputs.shadow_overdraw += texelFetch(layers_shadow_overdraw, pixel, 0);
}
