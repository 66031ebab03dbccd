// References: lib/screen_door.glsl, whose masks these taps meet; Vogel, "A Better Way to Construct the Sunflower
//             Head", 1979.
// Summary: taps into a shadow map of masked surfaces, spread over a disc. A mask decides which taps a surface hides, so
//          the taps for each texel of a mask form their own spiral over the disc, and those of texels that masks keep
//          together are rotated and scaled differently. Every mask then samples the disc evenly; with a single spiral
//          shared by all texels, half of a mask's taps would lie in few directions.

#include "lib/screen_door.glsl"

// The four texels around the point, with weights that include part of a fifth: the kept share of every 4 x 4 block is
// the same everywhere.
const int FILTER_TEXELS = 6;
vec2 hard_filter(vec2 distance) {
  return clamp(2.5 - abs(distance), 0.0, 1.0);
}

// A mask hides some of them; if several surfaces block, their mean depth is that of the kept ones.
const int SEARCH_TAPS = 2 * SOFT_SAMPLES, FILTER_TAPS = 4 * SOFT_SAMPLES;

// The square of the radius, evenly over the disc: a search that is denser in the middle leaves combs in the penumbrae of
// masks.
float searched(float radius) {
  return radius * radius;
}

// Radius and angle in the unit disc. count: a multiple of 16.
vec2 soft_tap(int number, int count) {
  ivec2 place = ivec2(number & 3, (number >> 2) & 3);
  int turned = 4 * mask_level(2, place) + mask_level(4, place), widened = 4 * mask_level(3, place) + mask_level(1, place);
  float turn = float(number >> 4);
  float share = (turn + (float(widened) + shadow_turn) / 16.0) * 16.0 / float(count);
  return vec2(sqrt(share), (turn + shadow_turn) * GOLDEN_ANGLE + float(turned) * (6.28318531 / 16.0));
}

// The texel nearest to that point of the map with the tap's texel of a mask.
ivec2 soft_texel(vec2 at, int number) {
  ivec2 place = ivec2(number & 3, (number >> 2) & 3);
  return place + 4 * ivec2(floor((at - vec2(place) - 0.5) / 4.0 + 0.5));
}

int inside_row(int texel, int size) {
  int last = size - 4;
  int inside = texel < 0 ? texel & 3 : (texel < size ? texel : last + ((texel - last) & 3));
  return clamp(inside, 0, size - 1);
}

// The nearest texel of the map, size by size, with the same texel of a mask; masks are complete beyond the border too.
ivec2 inside_map(ivec2 texel, int size) {
  return ivec2(inside_row(texel.x, size), inside_row(texel.y, size));
}
