// References: none needed.
// Summary: a depth that is beyond all.

const float FARTHEST = 3.4e38;
