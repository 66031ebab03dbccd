// References: McGuire, Bavoil, "Weighted Blended Order-Independent Transparency", JCGT 2013; this project.
// Summary: each remaining surface transmits the share 1 - opacity, so logarithms add up.

const float MOST_OPAQUE = 0.999;

// A splat's contribution, beside its weight.
float rest_term(float opacity) {
  return -log(1.0 - min(opacity, MOST_OPAQUE));
}

// The opacity of all together. sums: of terms and weights; of_opacity: of weights times opacity; one: weight of the
// splats of one surface, or 0.
float rest_hidden(vec2 sums, float of_opacity, float one) {
  return 1.0 - exp(-sums.x / (one > 0.0 ? one : sums.y));
}
