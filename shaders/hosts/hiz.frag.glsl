// References: Greene, Kass, Miller, "Hierarchical Z-Buffer Visibility", SIGGRAPH 1993 (one level of its pyramid).
// Summary: the farthest visible depth in each cell of samples and HIZ_REACH around it.

#include "lib/hiz_cells.glsl"

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * HIZ_CELL - HIZ_REACH, last = textureSize(depth_bounds, 0) - 1;
  float farthest = -3.4e38;
  for (int y = 0; y < HIZ_CELL + 2 * HIZ_REACH; y++) {
    for (int x = 0; x < HIZ_CELL + 2 * HIZ_REACH; x++) {
      farthest = max(farthest, texelFetch(depth_bounds, clamp(first + ivec2(x, y), ivec2(0), last), 0).z);
    }
  }
  hiz = farthest;
}
