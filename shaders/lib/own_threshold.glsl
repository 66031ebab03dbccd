// References: Wyman, McGuire, "Hashed Alpha Testing", 2017; Kensler, "Correlated Multi-Jittered Sampling", 2013 (each
//             pattern a permutation of the same strata); Jarzynski, Olano, "Hash Functions for GPU Rendering", 2020.
// Summary: thresholds of opacity, in sixteenths. Each surface has all sixteen in every 4 x 4 block of samples, and in
//          every 16 pictures of one sample, in an order of its own. So a surface keeps its area, and surfaces behind one
//          another let through the product of what each does. All of it is whole numbers, which all passes and devices
//          have alike.

uint hashed(uint x) {
  x = x * 747796405u + 2891336453u;
  uint word = ((x >> ((x >> 28) + 4u)) ^ x) * 277803737u;
  return (word >> 22) ^ word;
}

// The place of one of sixteen in an order that 20 bits choose.
uint reordered(uint place, uint order) {
  place = (place + order) & 15u;
  place = place * (2u * ((order >> 4) & 7u) + 1u) & 15u;
  place ^= place >> 2;
  place = (place * (2u * ((order >> 7) & 7u) + 1u) + (order >> 10)) & 15u;
  place ^= place >> 1;
  return (place * (2u * ((order >> 14) & 7u) + 1u) + (order >> 17)) & 15u;
}

// A surface's own number, of 24 bits.
float surface_number(int triangle, int object) {
  return float(hashed(uint(triangle) ^ hashed(uint(object))) >> 8);
}

// From 0 to 1. turned: the number of the picture with its 16 bits from last to first, by which strata are halved.
float own_threshold(float surface, ivec2 texel, float turned) {
  uvec2 block = uvec2(texel >> 2) & 0xFFFFu, within = uvec2(texel & 3);
  uint order = hashed(uint(surface) ^ hashed(block.x | block.y << 16)), turn = uint(turned);
  // 2 x 2 samples of four pictures have all strata as well, as far as the order keeps them together
  uint place = (within.x & 1u) | (within.y & 1u) << 1 | (within.x & 2u) << 1 | (within.y & 2u) << 2;
  uint stratum = reordered(place ^ turn >> 12, order), part = (hashed(order + place) ^ turn) & 4095u;
  return (float(stratum << 12 | part) + 0.5) / 65536.0;
}
