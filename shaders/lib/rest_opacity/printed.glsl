// References: Guennebaud, Barthe, Paulin 2006, section 6 (the last layer's weights are modulated by the opacities).
// Summary: everything left counts as one surface, with the mean opacity under the modulated weights.

// A splat's contribution, beside its weight.
float rest_term(float opacity) {
  return opacity * opacity;
}

// The opacity of all together; for the arguments see lib/rest_opacity/surfaces.glsl.
float rest_hidden(vec2 sums, float of_opacity, float one) {
  return sums.x / of_opacity;
}
