// References: Blender manual, "Passes".
// Summary: outputs the emitted light of a surface.

#part outputs
void emission_output_write(Outputs values) {
  out_emission_output = vec4(values.emission, 1.0);
}

#part sample_outputs
void emission_output_read(inout Outputs values, ivec2 texel) {
  values.emission = texelFetch(sample_emission_output, texel, 0).rgb;
}

#part before_layers, layers_emission_output
void emission_output_hand(ivec2 pixel, inout Outputs outputs) {
  outputs.emission += texelFetch(layers_emission_output, pixel, 0).rgb;
}
