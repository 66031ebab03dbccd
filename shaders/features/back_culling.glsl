// References: Botsch, Kobbelt 2003, section 4 (back faces are dropped in the vertex stage).
// Summary: splats that face away are not drawn.

#part splat
void back_culling_hide(inout Splat splat) {
  splat.is_hidden = splat.is_hidden || splat.is_back;
}
