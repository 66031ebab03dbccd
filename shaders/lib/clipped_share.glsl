// References: features/clip_lines.glsl; Sheppard 1899 (two correlated normal variables, both above their means).
// Summary: the share of kernel times pixel filter on the kept side of a splat's lines, over how dense kernels are there.

#include "lib/place.glsl"
#include "lib/normal_share.glsl"
#include "lib/kernel_under_pixel.glsl"

const float TWO_OVER_PI = 0.63661977;
const float LEAST_SHARE = 0.006;  // smaller shares are 0: the approximation ends there
const float LEAST_WITHIN = 0.05;  // the least share within the rim that divides

// The share of a Gaussian on the kept side of both lines. one, other: the share of each line alone; correlation: of the
// distances to them. Exact if both lines go through the middle, and for parallel or perpendicular lines.
float both_keep(float one, float other, float correlation) {
  float turn = asin(clamp(correlation, -1.0, 1.0)) * TWO_OVER_PI;
  return mix(one * other, turn > 0.0 ? min(one, other) : max(one + other - 1.0, 0.0), abs(turn));
}

// Normal distribution function of x; 1 where the approximation ends.
float share_before(float x) {
  return x < NORMAL_END ? share_beyond(-max(x, -NORMAL_END)) : 1.0;
}

// How dense the kernels of equally spaced splats lie where a pixel sees their kept sides, 1 far from a line. Their
// centres are on that side alone, so at the line they are half as dense; without this, creases would be sharper than the
// filter. The mean distance of what is kept of a Gaussian, and the density there, are fitted curves. Between two lines
// that face each other, both mean distances add up to no more than the strip's width, and its rows are counted.
// inside: distance from both lines, in deviations of kernel times pixel.
float kernel_density(vec2 inside, vec2 deviation) {
  vec2 mean = 0.5 * (inside + sqrt(inside * inside + 4.0 * TWO_OVER_PI)) * deviation;
  mean = min(mean * mix(1.0, min(clip_strip.y / (mean.x + mean.y), 1.0), clip_strip.x), vec2(1.0));
  vec2 one = 0.5 + mean - 0.5 * mean * mean;
  float both = one.x * one.y;
  if (clip_is_reflex > 0.5) return one.x + one.y - both;
  return mix(both, (one.x + one.y - 1.0) * clip_strip.z, clip_strip.x);
}

// The method's weight ends at the rim, and what lies beyond a line may lie beyond the rim, too: how much a line keeps of
// the part within the rim, from its share of all. together: squared correlation of the distances to line and rim.
vec2 share_within_rim(vec2 share, vec2 q, vec2 middle, mat2 seen, vec2 deviation) {
  vec2 outward = q * inversesqrt(max(dot(q, q), 1e-20)), across = seen * outward;
  float variance = max(dot(outward, across), 1e-20);
  float within = max(share_before((1.0 - dot(outward, middle)) * inversesqrt(variance)), LEAST_WITHIN);
  vec2 together = max(-vec2(dot(clip_first.xy, across), dot(clip_second.xy, across)), vec2(0.0)) / deviation;
  return mix(share, min(share / within, vec2(1.0)), min(together * together / variance, vec2(1.0)));
}

float clipped_share(Plane plane, Place place) {
  vec2 middle;
  mat2 seen;
  // Beyond the plane's horizon only the splat itself is meaningful.
  vec2 q = place.k > 0.0 ? place.uv : vec2(LARGEST_PIXEL);
  kernel_under_pixel(q, place.scale * place_turn(plane, place), view.filter_variance, middle, seen);
  vec2 across = seen * clip_first.xy;
  vec2 deviation = sqrt(max(vec2(dot(clip_first.xy, across), dot(clip_second.xy, seen * clip_second.xy)), 1e-20));
  vec2 inside = vec2(dot(clip_first.xy, middle) + clip_first.z, dot(clip_second.xy, middle) + clip_second.z) / deviation;
  vec2 kept = vec2(share_before(inside.x), share_before(inside.y));
  kept = share_within_rim(kept, q, middle, seen, deviation);
  float one = kept.x, other = kept.y;
  float both = both_keep(one, other, dot(clip_second.xy, across) / (deviation.x * deviation.y));
  float share = clip_is_reflex > 0.5 ? one + other - both : both;
  return share > LEAST_SHARE ? share / kernel_density(inside, deviation) : 0.0;
}
