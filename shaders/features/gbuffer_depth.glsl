// References: docs/evidence/numerics.md, Formats.
// Summary: stores depths and their weights separately in float32, if sums are float16 or colours are weighted by
//          opacity.

#part gbuffer
void gbuffer_depth_add(inout Fragment f) {
  gbuffer_normal = vec4(f.normal, f.lift) * f.weight;
  gbuffer_depth.xy = vec2(f.depth, 1.0) * f.weight;
}

#part mean_surface, layer
// There colours are weighted by opacity, so the weights are stored beside the depths.
void gbuffer_depth_layer_mean(inout float weights, inout vec4 n, ivec2 texel, int tap) {
  weights = SUM_AT(gbuffer_depth, texel, tap).y;
}

#part mean_surface
void gbuffer_depth_mean(inout float weights, inout vec4 n, ivec2 texel, int tap) {
  vec2 depths = SUM_AT(gbuffer_depth, texel, tap).xy;
  n /= weights;
  n.w = depths.x / depths.y;
}
