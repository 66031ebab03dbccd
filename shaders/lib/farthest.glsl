// References: none needed.
// Summary: a depth beyond everything.

const float FARTHEST = 3.4e38;
