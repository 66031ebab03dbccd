// References: Botsch et al. 2005, sections 3 and 5, with the paper's square around each splat.
// Summary: for comparison with `raycast.glsl`: fragments are limited to a square with the splat's size on the axis, at
//          least 2 x 2 pixels, which cuts the low-pass disc, and splats off the axis; where only the low-pass reaches,
//          depth is that of the plane. The twin of reference/methods/raycast_printed.py.

const bool AS_PRINTED = true;
#include "lib/raycast.glsl"
