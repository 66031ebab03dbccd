// References: Zwicker et al. 2001 (the resampling filter), taken to the splat's plane with the exact Jacobian of
//             every pixel, in the style of AA-2DGS (arXiv 2506.11252); this project.
// Summary: the pixel's Gaussian is mapped into the splat's plane, combined with the kernel there and scaled to preserve
//          its integral: neither tiny nor stretched splats lose or gain weight. The kernel's rim is blurred by the
//          pixel's Gaussian; splats larger than pixels are blurred nowhere else. The twin of reference/methods/mip.py.

#include "lib/kernel_variance.glsl"

const float RIM_END = 1.4;  // standard deviations beyond the rim at which the weight becomes 0

// The triangle around the footprint is drawn in any case; pixels within this multiple of the ellipse count, and its
// corners, where weights are negligible, do not.
const float FOOTPRINT_END = 1.5;

#part vertex
void adjust(inout Splat splat, inout Plane plane, bool is_orthographic) {}

// Nothing counts beyond the triangle around 1.8 sigma of kernel and filter, and 0.75 pixel around the splat's rim, of
// a filter of variance 0.5 or less.
vec2 footprint(Plane plane, vec2 size, inout vec2 middle) {
  float wider = max(sqrt(2.0 * view.filter_variance), 1.0);
  return max(sqrt(size * size + 1.25 * 1.25 * wider * wider), size + 0.75 * wider);
}
#part fragment
#include "lib/normal_share.glsl"

// Weight and depth.
vec2 splat_sample(Plane plane, vec2 pixel) {
  Place place = place_at(plane, pixel);
  mat2 turn = place_turn(plane, place);
  vec2 q = place.uv, across_rim = q * turn;
  // The pixel's variance in the plane, along both axes and across: filter_variance J J^T with J = scale turn. det J and
  // q x J are multiplied out, because edge-on their differences lose all precision in float32.
  float variance = view.filter_variance * place.scale * place.scale;
  float spread = view.filter_variance * place.k * place.scale;
  float det = spread * spread
      + KERNEL_VARIANCE * (variance * (dot(turn[0], turn[0]) + dot(turn[1], turn[1])) + KERNEL_VARIANCE);
  float amplitude = inversesqrt(det), reach2 = max(dot(q, q), 1e-30);
  float rho2 = KERNEL_VARIANCE * amplitude * amplitude
      * (KERNEL_VARIANCE * reach2 + variance * dot(place.d, place.d));
  // The kernel ends at its rim. Along the line from the centre, kernel times pixel is a Gaussian about KERNEL_VARIANCE
  // / both of the way; the pixel sees the part of it within the rim.
  float over_reach = inversesqrt(reach2);
  float along = clamp(variance * over_reach * over_reach * dot(across_rim, across_rim), 1e-12, 1e15);
  float both = KERNEL_VARIANCE + along;
  float x = (KERNEL_VARIANCE * reach2 * over_reach - both) * inversesqrt(both * KERNEL_VARIANCE * along);
  bool is_within = place.k > 0.0 && x < RIM_END;
  float within = share_beyond(clamp(x, -NORMAL_END, RIM_END));
  float weight = KERNEL_VARIANCE * amplitude * exp(-2.0 * rho2) * within;
  return vec2(is_within ? weight : 0.0, plane_depth(plane, place));
}
