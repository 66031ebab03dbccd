// References: none needed.
// Summary: a texel of the sums, or one of its hardware samples.

#define SUM_AT(sums, texel, tap) texelFetch(sums, texel, tap)
#define SIZE_OF(sums) textureSize(sums, 0)
const bool IS_MEAN = false;
