// References: Guennebaud, Barthe, Paulin 2006, section 6 (depth peeling of splats).
// Summary: the result of nearer transparent layers at each sample. `peel_state` stores the depth up to which splats are
//          in them (0 before the first layer, 1 if nothing is left), and the share of the background that they hide,
//          negative if one of them is opaque enough to provide depth and normal.

bool is_peeled(float stored, ivec2 at) {
  float until = texelFetch(peel_state, at, 0).x;
  return until > 0.0 && stored <= until;
}

float let_through(ivec2 at) {
  return 1.0 - abs(texelFetch(peel_state, at, 0).y);
}

bool is_first_surface(ivec2 at) {
  return texelFetch(peel_state, at, 0).y >= 0.0;
}
