// References: Botsch et al. 2005, section 4.
// Summary: the sum of depths beside that of normals, where nothing else weighs what depths do.

#part gbuffer
void depth_in_normals_add(inout Fragment f) {
  gbuffer_normal = vec4(normal, f.depth) * f.weight;
}

#part mean_surface
void depth_in_normals_mean(inout float weights, inout vec4 n, ivec2 texel, int tap) {
  n /= weights;
}
