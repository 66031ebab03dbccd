// References: Guennebaud, Barthe, Paulin 2006, section 4, equations 8 to 10 as they are printed.
// Summary: for comparison with `homogeneous.glsl`, which is repaired: a disc that faces the ray vanishes, and small
//          splats lose the depth of their planes. The twin of reference/methods/homogeneous_printed.py.

const bool AS_PRINTED = true;
#include "lib/homogeneous.glsl"
