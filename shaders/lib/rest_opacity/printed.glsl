// References: Guennebaud, Barthe, Paulin 2006, section 6 (the last layer's weights are modulated by the opacities).
// Summary: all that is left is as one surface, of the mean opacity under the modulated weights.

// What a splat adds, beside its weight.
float rest_term(float opacity) {
  return opacity * opacity;
}

// What all hide; the arguments are those of lib/rest_opacity/surfaces.glsl.
float rest_hidden(vec2 sums, float of_opacity, float one) {
  return sums.x / of_opacity;
}
