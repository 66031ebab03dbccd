// References: Botsch, Kobbelt 2003, section 3, with equation 4 as it is printed.
// Summary: kept for comparison with `sprites.glsl`: depths are corrected by too much, or too little, and the wrong way.
//          The twin of reference/methods/sprites_printed.py.

const bool AS_PRINTED = true;
#include "lib/sprites.glsl"
