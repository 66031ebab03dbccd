// References: none needed.
// Summary: how far each sample sees, as depth along the view: z is a depth that hides nothing if the sample is empty, w
//          one that nothing is in front of. x and y are the nearest and farthest stored depths that a silhouette filter
//          reaches in the sample's rows of visibility. Hooks: `reach` of a filter, `write` further values of the first
//          row, `bound` changes what is visible.

#include "depth_formats/{depth_format}.glsl"
#include "lib/silhouette_filter.glsl"

const float NOTHING_SEEN = 3e38;

#parts
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float own = texelFetch(seen_depth, ivec2(texel.x, ROWS * texel.y), 0).r;
  vec2 row = vec2(own);
  #hook reach(texel, row)
  #hook write(texel, own)
  float depth = view_depth(own);
  // The farthest depth that is stored stands for all beyond, of which none hides another.
  depth_bounds = vec4(row, own < FARTHEST_STORED ? depth : NOTHING_SEEN, own < 1.0 ? depth : -NOTHING_SEEN);
  #hook bound(texel, own)
}
