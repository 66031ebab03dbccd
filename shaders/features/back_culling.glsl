// References: Botsch, Kobbelt 2003, section 4 (backs are dropped in the vertex stage).
// Summary: a splat whose back is seen is not drawn.

#part splat
void back_culling_hide(inout Splat splat) {
  splat.is_hidden = splat.is_hidden || splat.is_back;
}
