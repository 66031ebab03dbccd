// References: Blender manual, "Passes" (the passes of Cycles and EEVEE).
// Summary: the outputs of a sample beside colour, depth and normal. Hook: `write` to the targets of requested outputs:
//          of samples still to be filtered, of pixels, or of transparent layers.

struct Outputs {
  vec3 diffuse_color;
  vec3 emission;
  vec4 shadow_overdraw;  // unshadowed share of the lights, number of splats
};

const Outputs NO_OUTPUTS = Outputs(vec3(0.0), vec3(0.0), vec4(0.0));

Outputs added(Outputs a, Outputs b, float weight) {
  return Outputs(a.diffuse_color + b.diffuse_color * weight, a.emission + b.emission * weight,
                 a.shadow_overdraw + b.shadow_overdraw * weight);
}

// For a pixel with this coverage: beside it nothing is in shadow, as in EEVEE.
Outputs before_background(Outputs values, float coverage) {
  values.shadow_overdraw.rgb += 1.0 - min(coverage, 1.0);
  return values;
}

#parts
void write_outputs(Outputs values) {
  #hook write(values)
}
