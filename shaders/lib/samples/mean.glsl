// References: the view-independent paper, sections 4.3 and 5 (multisampling, then normalisation of the pixel's mean).
// Summary: the mean of a texel's MEAN_OF hardware samples.

vec4 mean_of_samples(sampler2DMS sums, ivec2 texel) {
  vec4 total = vec4(0.0);
  for (int i = 0; i < MEAN_OF; i++) total += texelFetch(sums, texel, i);
  return total / float(MEAN_OF);
}

#define SUM_AT(sums, texel, tap) mean_of_samples(sums, texel)
#define SIZE_OF(sums) textureSize(sums)
const bool IS_MEAN = true;
