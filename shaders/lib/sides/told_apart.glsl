// References: lib/sides.glsl.
// Summary: a back counts for little where there is a front.

const float BACK_WEIGHT = 1e-3;     // of a back against a front
const float BACK_EPSILON = 2.0;     // a back is moved away that much further
