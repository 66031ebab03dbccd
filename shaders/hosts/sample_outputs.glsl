// References: none needed.
// Summary: what a shaded sample was to hand on; 0 where nothing was shaded. Hook: `read` what is asked for.

#include "hosts/outputs.glsl"

#parts
Outputs sample_outputs(ivec2 texel) {
  Outputs values = NO_OUTPUTS;
  #hook read(values, texel)
  return values;
}
