// References: Blender manual, "Passes".
// Summary: outputs the diffuse colour of a lit surface, without its metallic part.

#part outputs
void diffuse_color_write(Outputs values) {
  out_diffuse_color = vec4(values.diffuse_color, 1.0);
}

#part sample_outputs
void diffuse_color_read(inout Outputs values, ivec2 texel) {
  values.diffuse_color = texelFetch(sample_diffuse_color, texel, 0).rgb;
}

#part before_layers, layers_diffuse_color
void diffuse_color_hand(ivec2 pixel, inout Outputs outputs) {
  outputs.diffuse_color += texelFetch(layers_diffuse_color, pixel, 0).rgb;
}

#part shaded_sample, has_material
// The metallic part of a surface has no diffuse colour.
void diffuse_color_outputs(inout Shaded s) {
  s.outputs.diffuse_color = s.mean.color * (1.0 - clamp(s.material.y, 0.0, 1.0));
}
