// References: Vogel, "A Better Way to Construct the Sunflower Head", 1979.
// Summary: taps of a shadow map along a spiral over a disc.

// A tent of two texels around the place.
const int FILTER_TEXELS = 4;
vec2 hard_filter(vec2 distance) {
  return max(2.0 - abs(distance), 0.0);
}

const int SEARCH_TAPS = SOFT_SAMPLES, FILTER_TAPS = SOFT_SAMPLES;

// Where the search for blockers has its taps, relative to its reach, from their radius in the unit disc.
float searched(float radius) {
  return radius * radius * radius * radius;
}

// Radius and angle in the unit disc.
vec2 soft_tap(int number, int count) {
  float at = float(number) + shadow_turn;
  return vec2(sqrt(at / float(count)), at * GOLDEN_ANGLE);
}

ivec2 soft_texel(vec2 at, int number) {
  return ivec2(floor(at));
}

// The nearest of the map's texels, size by size.
ivec2 inside_map(ivec2 texel, int size) {
  return clamp(texel, ivec2(0), ivec2(size - 1));
}
