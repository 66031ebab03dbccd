// References: Botsch et al. 2005, sections 3 and 4 (accumulation, normalised by the sum of weights in a later pass).
// Summary: adds a splat to a sample's sums. Hooks: `weigh`, `add`.

#include "sum_formats/{sum_format}.glsl"

struct Fragment {
  vec3 color;
  float weight;
  float depth;
  float opacity;  // weight factor of colours
  float lift;     // of the smooth surface above it, where shadows ask for it
  vec3 normal;    // for shading
};

#parts
void add_to_sums(vec3 color, float weight, float depth) {
  Fragment f = Fragment(color, weight, depth, 1.0, 0.0, normal);
  #hook weigh(f)
  #hook add(f)
}
