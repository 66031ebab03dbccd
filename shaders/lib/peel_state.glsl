// References: Guennebaud, Barthe, Paulin 2006, section 6 (depth peeling of splats).
// Summary: what nearer transparent layers leave at each sample: `peel_state` holds the stored depth up to which
//          splats are in them, 0 before the first and 1 where nothing is left; and the share of what lies behind that
//          they hide, negative where one of them is opaque enough to be the surface that depth and normal are of.

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
