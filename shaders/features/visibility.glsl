// References: Botsch et al. 2005, section 4.1 (visibility splatting).
// Summary: the depths that screen-space methods compare with.

#part screen_space.frag, depth_bounds
void visibility_bound(inout Candidate c) {
  c.seen = texelFetch(depth_bounds, ivec2(gl_FragCoord.xy), 0);
}

#part screen_space.frag, depth_bounds, opaque
void visibility_keep(inout Candidate c) {
  if (c.compared > c.seen.z) discard;
}
