// References: Blender manual, "Passes" (what Cycles and EEVEE hand on beside the picture).
// Summary: what a sample hands on beside its colour, depth and normal. Hook: `write` to the targets of those that are asked
//          for: of samples that are still to be filtered, of pixels, or what transparent layers add to them.

struct Outputs {
  vec3 diffuse_color;
  vec3 emission;
  vec4 shadow_overdraw;  // share of the lights that arrives, number of splats
};

const Outputs NO_OUTPUTS = Outputs(vec3(0.0), vec3(0.0), vec4(0.0));

Outputs added(Outputs a, Outputs b, float weight) {
  return Outputs(a.diffuse_color + b.diffuse_color * weight, a.emission + b.emission * weight,
                 a.shadow_overdraw + b.shadow_overdraw * weight);
}

// Of a pixel of which that share is covered: beside it nothing is in a shadow, as EEVEE has it.
Outputs before_background(Outputs values, float coverage) {
  values.shadow_overdraw.rgb += 1.0 - min(coverage, 1.0);
  return values;
}

#parts
void write_outputs(Outputs values) {
  #hook write(values)
}
