// References: none needed.
// Summary: the outputs of a shaded sample; 0 where nothing was shaded. Hook: `read` the requested ones.

#include "hosts/outputs.glsl"

#parts
Outputs sample_outputs(ivec2 texel) {
  Outputs values = NO_OUTPUTS;
  #hook read(values, texel)
  return values;
}
