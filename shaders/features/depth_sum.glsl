// References: docs/numerics.md, Formats.
// Summary: depths and their weights apart, in float32: where sums are float16, and where colours count by opacity.

#part gbuffer
void depth_sum_add(inout Fragment f) {
  normal_sum = vec4(normal, 0.0) * f.weight;
  depth_sum = vec2(f.depth, 1.0) * f.weight;
}

#part mean_surface, layer
// Colours count by opacity there: the weights are by the depths.
void depth_sum_layer_mean(inout float weights, inout vec4 n, ivec2 texel, int tap) {
  weights = SUM_AT(depth_sum, texel, tap).y;
}

#part mean_surface
void depth_sum_mean(inout float weights, inout vec4 n, ivec2 texel, int tap) {
  vec2 depths = SUM_AT(depth_sum, texel, tap).xy;
  n /= weights;
  n.w = depths.x / depths.y;
}
