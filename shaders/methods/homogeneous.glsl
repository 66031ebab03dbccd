// References: Guennebaud, Barthe, Paulin 2006, section 4: equations 8 to 10 (tangents lengthened until the splat is
//             as large as the pixel's filter), section 3: their projections exact and perspective.
// Summary: where a half-axis would be shorter than sqrt(2) pixels in the picture, it is replaced by one of that
//          length, parallel to the picture; then the kernel is evaluated as ever.
//          The twin of reference/methods/homogeneous.py.

const bool AS_PRINTED = false;
#include "lib/homogeneous.glsl"
