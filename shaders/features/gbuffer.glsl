// References: Botsch et al. 2005, section 4 (deferred shading: attributes are blended, not colours).
// Summary: the sums of colours and normals.

#part gbuffer
void gbuffer_weigh(inout Fragment f) {
  f.weight = stored_weight(f.weight);
}

void gbuffer_add(inout Fragment f) {
  gbuffer_color = vec4(stored_color(f.color), 1.0) * (f.weight * f.opacity);
}

#part screen_space.frag
void gbuffer_add(Candidate c) {
  add_to_sums(c.color, c.weight, c.depth);
}
