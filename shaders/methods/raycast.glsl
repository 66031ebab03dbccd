// References: Botsch et al. 2005, sections 3 and 5.
// Summary: the exact ellipse or the full disc of the low-pass, whichever has more weight; bounds are exact. The twin of
//          reference/methods/raycast.py.

const bool AS_PRINTED = false;
#include "lib/raycast.glsl"
