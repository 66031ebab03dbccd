// References: none needed.
// Summary: how many splats the sample that is shaded is the mean of.

float overdraw;
