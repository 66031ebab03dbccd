// References: Greene, Kass, Miller, "Hierarchical Z-Buffer Visibility", SIGGRAPH 1993.
// Summary: the farthest visible depth in each cell of samples while visibility is being drawn.

#include "depth_formats/{depth_format}.glsl"

const float SEES_ON = 3e38;

void main() {
  ivec2 last = textureSize(covering_depth, 0) - 1;
  ivec2 size = ivec2(COVER_CELL, COVER_CELL * ROWS), first = ivec2(gl_FragCoord.xy) * size;
  float farthest = 0.0;
  for (int y = 0; y < size.y; y++) {
    for (int x = 0; x < size.x; x++) {
      farthest = max(farthest, texelFetch(covering_depth, min(first + ivec2(x, y), last), 0).r);
    }
  }
  farthest_seen = farthest < FARTHEST_STORED ? view_depth(farthest) : SEES_ON;
}
