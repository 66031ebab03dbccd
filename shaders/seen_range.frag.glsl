// References: none needed.
// Summary: how far each sample sees, as depth along the view: in z what hides nothing where there is nothing, in w what
//          nothing is before. Of a transparent layer that is never behind what is opaque there. Where silhouettes are
//          filtered, x and y are the nearest and the farthest stored depth that the filter reaches in the sample's rows of
//          visibility; and what the first of them has of the sample is kept by itself. Where a hole is seen, w says so: it is
//          farther than all depths.

#define PROJECTION shading.projection
#define PARALLEL (shading.options.x > 0.5)
#define DEPTH_UNIT shading.options.z
#include "common/stored_depth.glsl"
#include "common/silhouette_filter.glsl"

#ifdef HAS_ROWS
#define HOLES row_holdout_depth
#else
#define HOLES holdout_depth
#endif

const float FARTHEST = 3e38;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float own = texelFetch(SEEN, ivec2(texel.x, ROWS * texel.y), 0).r;
  vec2 row = vec2(own);
#ifdef FILTERS_SILHOUETTES
  int last = textureSize(SEEN, 0).x - 1;
  for (int x = -COLUMN_REACH; x <= COLUMN_REACH; x++) {
    for (int y = 0; y < ROWS; y++) {
      float other = texelFetch(SEEN, ivec2(clamp(texel.x + x, 0, last), ROWS * texel.y + y), 0).r;
      row = vec2(min(row.x, other), max(row.y, other));
    }
  }
#endif
#ifdef HAS_ROWS
  gl_FragDepth = own;
#endif
#ifdef IDENTITY
  identity = texelFetch(row_identity, ivec2(texel.x, ROWS * texel.y), 0).xy;
#endif
#ifdef LAYER
  own = min(own, texelFetch(visibility_depth, texel, 0).r);
#endif
  float depth = view_depth(own);
  seen_range = vec4(row, own < 1.0 ? vec2(depth) : vec2(FARTHEST, -FARTHEST));
#ifdef HOLDOUT
  if (own < 1.0 && texelFetch(HOLES, ivec2(texel.x, ROWS * texel.y), 0).r <= own) seen_range.w = FARTHEST;
#endif
}
