// References: docs/numerics.md, which measures both.
// Summary: what the depth buffer holds. The hardware's depth, affine in 1 / z, costs nothing and leaves a resolution
//          of z / near / 2^24: enough where the plan says so. Elsewhere depth / far is written, whose float32 has 2^-24
//          of z at any distance.

const float FARTHEST_STORED = 0.9999998;  // 1 says that nothing was drawn

#ifndef VERTEX_STAGE
void write_depth(float depth) {
#ifdef LINEAR_DEPTH
  gl_FragDepth = min(depth * splats.options.w, FARTHEST_STORED);
#endif
}
#endif
