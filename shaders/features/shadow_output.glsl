// References: Blender manual, "Passes".
// Summary: outputs the share of the lights that is not shadowed.

#part lights
vec3 light_arriving, light_unshadowed;  // at the sample being shaded: sums of irradiance

// Per colour channel; 0 where no light comes from the front, as in EEVEE.
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
