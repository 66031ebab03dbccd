// References: Botsch et al. 2005, section 4.
// Summary: stores the sum of depths beside the sum of normals, if both have the same weights.

#part gbuffer
void depth_in_normals_add(inout Fragment f) {
  gbuffer_normal = vec4(f.normal, f.depth) * f.weight;
}

#part mean_surface
void depth_in_normals_mean(inout float weights, inout vec4 n, ivec2 texel, int tap) {
  n /= weights;
}
