// References: Guennebaud, Barthe, Paulin 2006, section 6; resolve.frag.glsl, whose filter this has.
// Summary: what all that is left behind the transparent layers adds to a pixel, under them.

#include "common/peeled.glsl"
#ifdef FILTERS_SILHOUETTES
#include "common/silhouette_filter.glsl"
#endif

vec4 seen_through(ivec2 texel) {
  vec4 own = texelFetch(shaded, texel, 0);
#ifdef FILTERS_SILHOUETTES
  ivec2 last = textureSize(shaded, 0) - 1;
  vec4 color = vec4(0.0);
  float total = 0.0;
  for (int y = -FILTER_REACH; y <= FILTER_REACH; y++) {
    for (int x = -COLUMN_REACH; x <= COLUMN_REACH; x++) {
      ivec2 at = clamp(texel + ivec2(x, y), ivec2(0), last);
      float weight = exp(-0.5 * float(y * y) / FILTER_VARIANCE) * (x == 0 ? 1.0 : COLUMN_RATIO);
      vec4 here = texelFetch(shaded, at, 0);
      if (own.w > 0.0) here = own * (here.w / own.w);
      color += weight * let_through(at) * here;
      total += weight;
    }
  }
  return color / total;
#else
  return own * let_through(texel);
#endif
}

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SAMPLES;
  layers = vec4(0.0);
  for (int y = 0; y < SAMPLES; y++) {
    for (int x = 0; x < SAMPLES; x++) layers += seen_through(first + ivec2(x, y));
  }
  layers /= float(SAMPLES * SAMPLES);
}
