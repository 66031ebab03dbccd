// References: hiz.frag.glsl.
// Summary: how many samples a cell has along each side, and how far around it is looked; what is around a place in a cell
//          and reaches no further needs one tap.

const int CELL_REACH = 2;
