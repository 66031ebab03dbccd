// References: features/clip_lines.glsl; Sheppard 1899 (two correlated normal variables, both above their means).
// Summary: the share of kernel times pixel filter on the kept side of a splat's lines, over how dense kernels are there.

#include "lib/place.glsl"
#include "lib/normal_share.glsl"
#include "lib/kernel_under_pixel.glsl"

const float LEAST_SHARE = 0.006;  // smaller shares are 0: the approximation ends there
const float WITHIN_TWO = 0.9533;  // of a Gaussian, within two standard deviations, by share_beyond

// The share of a Gaussian on the kept side of both lines. one, other: the share of each line alone; correlation: of the
// distances to them. Exact if both lines go through the middle, and for parallel or perpendicular lines.
float both_keep(float one, float other, float correlation) {
  float turn = asin(clamp(correlation, -1.0, 1.0)) * 0.63661977;
  return mix(one * other, turn > 0.0 ? min(one, other) : max(one + other - 1.0, 0.0), abs(turn));
}

// Normal distribution function of x; 1 where the approximation ends.
float share_before(float x) {
  return x < NORMAL_END ? share_beyond(-max(x, -NORMAL_END)) : 1.0;
}

// How dense the kernels of equally spaced splats lie where a pixel sees their kept sides, 1 far from lines. Their centres
// are on that side alone, so at a line they are half as dense; without this, creases would be sharper than the filter.
// Kernels end at two standard deviations. inside: of the pixel's part of the kernel, from a line, in deviations of it.
float kernel_density(float inside, float deviation) {
  // Within 0.05 up to 3 deviations of the mean of a normal distribution's kept side, and 2 % of it beyond.
  float mean = 0.5 * (inside + sqrt(inside * (inside - 0.74) + 2.29)) * deviation;
  return min(0.5 + (share_before(mean * inversesqrt(SPLAT_VARIANCE)) - 0.5) / WITHIN_TWO, 1.0);
}

float clipped_share(Plane plane, Place place) {
  vec2 middle;
  mat2 seen;
  // Beyond the plane's horizon only the splat itself is meaningful.
  vec2 q = place.k > 0.0 ? place.uv : vec2(LARGEST_PIXEL);
  kernel_under_pixel(q, place.scale * place_turn(plane, place), FILTER_VARIANCE, middle, seen);
  vec2 across = seen * clip_first.xy;
  vec2 deviation = sqrt(max(vec2(dot(clip_first.xy, across), dot(clip_second.xy, seen * clip_second.xy)), 1e-20));
  vec2 inside = vec2(dot(clip_first.xy, middle) + clip_first.z, dot(clip_second.xy, middle) + clip_second.z) / deviation;
  float one = share_before(inside.x), other = share_before(inside.y);
  float both = both_keep(one, other, dot(clip_second.xy, across) / (deviation.x * deviation.y));
  vec2 density = vec2(kernel_density(inside.x, deviation.x), kernel_density(inside.y, deviation.y));
  float share = clip_is_reflex > 0.5 ? one + other - both : both, all_density = density.x * density.y;
  if (clip_is_reflex > 0.5) all_density = density.x + density.y - all_density;
  return share > LEAST_SHARE ? share / all_density : 0.0;
}
