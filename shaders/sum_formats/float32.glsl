// References: docs/evidence/numerics.md, Formats.
// Summary: sums in float32 store weights and colours unchanged.

const float WEIGHT_SCALE = 1.0;
// A mean normal shorter than this is rounding error of normals that cancel; the surface then faces the viewer.
const float CANCELLED = 1e-6;

float stored_weight(float weight) {
  return weight;
}

vec3 stored_color(vec3 color) {
  return color;
}

vec3 summed_color(vec3 stored) {
  return stored;
}
