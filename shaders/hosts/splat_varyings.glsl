// References: none needed.
// Summary: what fragments are told of a splat beside its place. Hook: `attributes`.

#parts
void hand_on(Splat splat, int index) {
  #hook attributes(splat, index)
}
