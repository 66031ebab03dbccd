// References: resolve.frag.glsl.
// Summary: how far the filter of silhouettes reaches.

const int FILTER_REACH = 2;  // in samples, to each side; frame_plan.py has the same
