// References: none needed.
// Summary: of each sample's visibility samples the nearest and the farthest stored depth, and the one at its centre,
//          which becomes the depth that the attribute pass is tested with. Of a transparent layer that is never behind
//          what is opaque there.

#ifdef LAYER
#define SEEN layer_depth
#else
#define SEEN visibility_depth
#endif

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * VISIBILITY_SAMPLES;
  float low = 1.0, high = 0.0;
  for (int y = 0; y < VISIBILITY_SAMPLES; y++) {
    for (int x = 0; x < VISIBILITY_SAMPLES; x++) {
      float seen = texelFetch(SEEN, first + ivec2(x, y), 0).r;
      low = min(low, seen);
      high = max(high, seen);
    }
  }
  float center = texelFetch(SEEN, first + VISIBILITY_SAMPLES / 2, 0).r;
#ifdef LAYER
  center = min(center, texelFetch(visibility_depth, first + VISIBILITY_SAMPLES / 2, 0).r);
#endif
  seen_range = vec4(low, high, center, 0.0);
  gl_FragDepth = center;
}
