// References: none needed.
// Summary: the distance of nothing.

const float FAR = 1e30;
