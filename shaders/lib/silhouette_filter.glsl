// References: resolve.frag.glsl.
// Summary: width of the silhouette filter.

const float SILHOUETTE_VARIANCE = 0.5;  // of its Gaussian, in samples
// Across, 1 2 1: the same variance from fewer columns.
const int COLUMN_REACH = 1;
const float COLUMN_RATIO = 0.5;
