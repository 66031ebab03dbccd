// References: Greene, Kass, Miller, "Hierarchical Z-Buffer Visibility", SIGGRAPH 1993.
// Summary: whether a splat lies behind all that is seen where it would be drawn. Every fragment of such a one would be
//          discarded: the picture is the same without it.

#include "lib/hiz_cells.glsl"

const float MOST_REACH = 8.0;  // samples; larger splats are drawn: fetches would cost more than they save

// middle, reach: a box around what is drawn of it, in samples. nearest: of its depths.
bool is_behind_all(vec2 middle, vec2 reach, float nearest) {
  bool is_looked_up = max(reach.x, reach.y) <= MOST_REACH;
  vec2 beyond = max(reach - float(CELL_REACH), 0.0);
  vec2 last = vec2(textureSize(hiz, 0) - 1);
  ivec2 first = ivec2(clamp((middle - beyond) / float(CELL), vec2(0.0), last));
  ivec2 end = ivec2(clamp((middle + beyond) / float(CELL), vec2(0.0), last));
  end = is_looked_up ? end : first - 1;
  float farthest = is_looked_up ? -3.4e38 : 3.4e38;
  for (int y = first.y; y <= end.y; y++) {
    for (int x = first.x; x <= end.x; x++) farthest = max(farthest, texelFetch(hiz, ivec2(x, y), 0).r);
  }
  return nearest > farthest;
}
