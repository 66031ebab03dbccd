// References: hiz.frag.glsl.
// Summary: number of samples along each side of a cell, and the reach around a cell in which its farthest depth is
//          taken. The surroundings of a point within that reach need only one tap.

const int HIZ_REACH = 2;
