// References: the view-independent paper, sections 4.3 and 5 (multisampling, then normalisation of the pixel's mean).
// Summary: a texel of the sums, or one of its hardware samples (LOOKS of them), or the mean of those (MEAN_OF).

#ifdef MEAN_OF
vec4 mean_of_samples(sampler2DMS sums, ivec2 texel) {
  vec4 total = vec4(0.0);
  for (int i = 0; i < MEAN_OF; i++) total += texelFetch(sums, texel, i);
  return total / float(MEAN_OF);
}
#define SUM_AT(sums, texel, look) mean_of_samples(sums, texel)
#else
#define SUM_AT(sums, texel, look) texelFetch(sums, texel, look)
#endif
