// References: Botsch and Kobbelt 2003, Botsch et al. 2005, Guennebaud et al. 2006: none tells sides apart where splats blend.
// Summary: backs are treated like fronts, as in the papers.

const float BACK_WEIGHT = 1.0;
const float BACK_EPSILON = 1.0;
