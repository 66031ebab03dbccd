// References: docs/numerics.md, Formats.
// Summary: what weights are multiplied by in the sums. Of weights up to 1 a float16 sum stops growing at 2048, here at
//          32768, which float16 (up to 65504) holds; and the smallest it holds is then a 16th as small.

#ifdef HALF_SUMS
const float WEIGHT_SCALE = 16.0;
#else
const float WEIGHT_SCALE = 1.0;
#endif
