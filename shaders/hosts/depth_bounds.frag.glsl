// References: none needed.
// Summary: how far each sample sees, as depth along the view: in z what hides nothing where there is nothing, in w what
//          nothing is before. x and y are the nearest and the farthest stored depth that a filter of silhouettes reaches in
//          the sample's rows of visibility. Hooks: `reach` of a filter, `write` what else is kept of the first of the rows,
//          `bound` where something else is seen.

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
  depth_bounds = vec4(row, own < 1.0 ? vec2(depth) : vec2(NOTHING_SEEN, -NOTHING_SEEN));
  #hook bound(texel, own)
}
