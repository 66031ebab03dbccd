// References: none needed.
// Summary: what fragments are told of a splat beside its place. Hook: `tell`.

#parts
void hand_on(Splat splat, int index) {
  #hook tell(splat, index)
}
