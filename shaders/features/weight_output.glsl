// References: none needed.
// Summary: the sum of weights that a sample was divided by, for the shading model that displays it.

#part shaded_sample
void weight_output_prepare(inout Shaded s) {
  sum_of_weights = s.mean.weight / WEIGHT_SCALE;
}
