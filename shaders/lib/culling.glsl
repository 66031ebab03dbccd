// References: Greene, Kass, Miller, "Hierarchical Z-Buffer Visibility", SIGGRAPH 1993.
// Summary: whether a splat is behind everything visible in its area. All its fragments would be discarded, so the
//          picture does not change without it.

#include "lib/hiz_cells.glsl"

const float MOST_REACH = 8.0;  // samples; larger splats are drawn, because fetches would cost more than they save

// middle, reach: a box around the splat, in samples. nearest: its smallest depth.
bool is_behind_all(vec2 middle, vec2 reach, float nearest) {
  bool is_looked_up = max(reach.x, reach.y) <= MOST_REACH;
  vec2 beyond = max(reach - float(HIZ_REACH), 0.0);
  vec2 last = vec2(textureSize(hiz, 0) - 1);
  ivec2 first = ivec2(clamp((middle - beyond) / float(HIZ_CELL), vec2(0.0), last));
  ivec2 end = ivec2(clamp((middle + beyond) / float(HIZ_CELL), vec2(0.0), last));
  end = is_looked_up ? end : first - 1;
  float farthest = is_looked_up ? -3.4e38 : 3.4e38;
  for (int y = first.y; y <= end.y; y++) {
    for (int x = first.x; x <= end.x; x++) farthest = max(farthest, texelFetch(hiz, ivec2(x, y), 0).r);
  }
  return nearest > farthest;
}
