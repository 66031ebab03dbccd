// References: Botsch, Kobbelt 2003, section 3, with equations 1 and 4 as they are printed.
// Summary: for comparison with `sprites.glsl`: sprites have half the size, and the depth correction has the wrong length
//          and sign; up to twice the near plane's distance, all splats have one depth. The twin of
//          reference/methods/sprites_printed.py.

const bool AS_PRINTED = true;
#include "lib/sprites.glsl"
