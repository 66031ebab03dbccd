// References: resolve.frag.glsl.
// Summary: how wide the filter of silhouettes is, and what it looks at: where there are no transparent layers, visibility has
//          two rows to each row of samples (HAS_ROWS), one through their centres and one halfway to the next. frame_plan.py
//          has the same numbers.

const float FILTER_VARIANCE = 0.5;  // of its Gaussian, in samples
const int FILTER_REACH = 2;  // rows of samples, up and down
// Across, 1 2 1: the same variance from fewer columns.
const int COLUMN_REACH = 1;
const float COLUMN_RATIO = 0.5;
#ifdef HAS_ROWS
#define SEEN row_depth
const int ROWS = 2;
#elif defined(LAYER)
#define SEEN layer_depth
const int ROWS = 1;
#else
#define SEEN visibility_depth
const int ROWS = 1;
#endif
