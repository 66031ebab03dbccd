// References: hiz.frag.glsl.
// Summary: number of samples along each side of a cell, and the border around it that the cell covers; the surroundings
//          of a point within that border need only one tap.

const int HIZ_REACH = 2;
