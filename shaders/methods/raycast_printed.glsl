// References: Botsch et al. 2005, sections 3 and 5, with the paper's square around each splat.
// Summary: kept for comparison with `raycast.glsl`: what lies outside of a square of the splat's size on the axis, at least
//          2 x 2 pixels, is not drawn: it cuts the low-pass's disc, and splats off the axis.
//          The twin of reference/methods/raycast_printed.py.

const bool AS_PRINTED = true;
#include "lib/raycast.glsl"
