// References: McGuire, Bavoil, "Weighted Blended Order-Independent Transparency", JCGT 2013; this project.
// Summary: each of the surfaces that are left lets the share 1 - opacity through, so that logarithms add up.

const float MOST_OPAQUE = 0.999;

// What a splat adds, beside its weight.
float rest_term(float opacity) {
  return -log(1.0 - min(opacity, MOST_OPAQUE));
}

// What all hide. sums: of terms and weights; of_opacity: of weights times opacity; one: what a surface's splats weigh, or 0.
float rest_hidden(vec2 sums, float of_opacity, float one) {
  return 1.0 - exp(-sums.x / (one > 0.0 ? one : sums.y));
}
