// References: none needed.
// Summary: varyings of a splat other than its position. Hook: `tell`.

#parts
void hand_on(Splat splat, int index) {
  #hook tell(splat, index)
}
