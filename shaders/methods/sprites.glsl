// References: Botsch, Kobbelt, "High-Quality Point-Based Rendering on Modern GPUs", 2003, section 3; equations 1 and 4
//             corrected.
// Summary: discs in point sprites, with the same shape and depth for visibility. The twin of
//          reference/methods/sprites.py.

const bool AS_PRINTED = false;
#include "lib/sprites.glsl"
