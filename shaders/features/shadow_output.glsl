// References: Blender manual, "Passes".
// Summary: the share of the lights that arrives.

#part lights
vec3 light_arriving, light_unshadowed;  // at the sample that is shaded: sums of irradiance

// Of each colour; 0 where no light comes from the front, as EEVEE has it.
vec3 shadow_share() {
  return light_arriving / mix(light_unshadowed, vec3(1.0), equal(light_unshadowed, vec3(0.0)));
}

void shadow_output_reach(inout Incident here, vec3 normal) {
  light_unshadowed += here.irradiance * max(dot(normal, here.to_light), 0.0);
}

void shadow_output_arrive(inout Incident here, vec3 normal) {
  light_arriving += here.irradiance * max(dot(normal, here.to_light), 0.0);
}

#part shaded_sample
void shadow_output_prepare(inout Shaded s) {
  light_arriving = light_unshadowed = vec3(0.0);
}

void shadow_output_outputs(inout Shaded s) {
  s.outputs.shadow_overdraw.rgb = shadow_share();
}

#part lit_splats.frag
void shadow_output_prepare(Splat splat, int index) {
  light_arriving = light_unshadowed = vec3(0.0);
}
