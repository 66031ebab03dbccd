// References: resolve.frag.glsl.
// Summary: how wide the filter of silhouettes is.

const float FILTER_VARIANCE = 0.5;  // of its Gaussian, in samples
const int FILTER_REACH = 2;  // in samples, to each side; frame_plan.py has the same
