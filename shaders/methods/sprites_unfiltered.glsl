// References: Botsch, Kobbelt 2003, sections 3.1, 3.2 and 5 (the faster of two quality levels: size and shape of the
//             splats, neither blending nor a depth for each pixel).
// Summary: a disc in a sprite around its centre, bounded by the depth offset of its plane; its depth is the centre's.
//          The twin of reference/methods/sprites_unfiltered.py.

#include "lib/disc_in_sprite.glsl"
