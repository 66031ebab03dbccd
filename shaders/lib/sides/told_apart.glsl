// References: lib/sides.glsl.
// Summary: a back gets little weight where there is a front.

const float BACK_WEIGHT = 1e-3;     // weight of a back relative to a front
const float BACK_EPSILON = 2.0;     // a back is moved back by this factor
