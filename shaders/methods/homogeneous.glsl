// References: Guennebaud, Barthe, Paulin 2006, section 4: equations 8 to 10 (tangents lengthened until the splat is
//             as large as the pixel's filter), section 3: their projections exact and perspective.
// Summary: a half-axis shorter than sqrt(2) pixels in the picture is replaced by one of that length parallel to the
//          picture; then the kernel is evaluated as usual. The twin of reference/methods/homogeneous.py.

const bool AS_PRINTED = false;
#include "lib/homogeneous.glsl"
