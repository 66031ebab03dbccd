// References: resolve.frag.glsl.
// Summary: the columns of the silhouette filter, whose rows are weighted by its Gaussian.

// Of the three columns, the outer ones count by this much of the middle one, which gives them the Gaussian's variance.
const int COLUMN_REACH = 1;
float column_ratio() {
  return 0.5 * view.filter_variance / (1.0 - view.filter_variance);
}
