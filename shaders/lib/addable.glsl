// References: none needed.
// Summary: numbers of a sample that are finite, and small enough to be added up over all samples.

bool is_addable(vec4 texel) {
  return all(lessThanEqual(abs(texel), vec4(MOST_ADDED)));
}
