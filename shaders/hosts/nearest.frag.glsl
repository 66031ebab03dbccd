// References: none needed.
// Summary: keeps the depth of those of a sample's pixels, without the margin of its tile, that are nearer than all previous
//          ones; the hardware compares them.

#include "lib/addable.glsl"

void main() {
  vec4 seen = texelFetch(depth, ivec2(gl_FragCoord.xy) - ivec2(frame.corner.xy), 0);
  nearest_depth = is_addable(seen) ? seen.r : 1e10;
  gl_FragDepth = nearest_depth * DEPTH_KEY;
}
