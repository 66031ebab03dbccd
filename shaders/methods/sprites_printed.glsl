// References: Botsch, Kobbelt 2003, section 3, with equation 4 as it is printed.
// Summary: for comparison with `sprites.glsl`: the depth correction has the wrong length and sign. The twin of
//          reference/methods/sprites_printed.py.

const bool AS_PRINTED = true;
#include "lib/sprites.glsl"
