// References: Zwicker, Pfister, van Baar, Gross, "Surface Splatting", 2001, equations 9 to 12; Ren et al. 2002; the
//             amplitude that keeps the integral: Yu et al., "Mip-Splatting", 2024.
// Summary: the classic reference method: the splat's projection is approximated as affine at its centre and combined
//          with the pixel's Gaussian in the picture. The twin of reference/methods/ewa.py.

#include "lib/kernel_variance.glsl"

const float FOOTPRINT_END = 1.0;

#part vertex
void adjust(inout Splat splat, inout Plane plane, bool is_orthographic) {}

// Only around the exact ellipse: the affine one of a near splat can fill the picture.
vec2 footprint(Plane plane, vec2 size, inout vec2 middle) {
  return 1.1 * sqrt(size * size + 4.0 * view.filter_variance);
}
#part fragment
// Weight and depth.
vec2 splat_sample(Plane plane, vec2 pixel) {
  Place place = place_at(plane, pixel);
  vec2 a = plane.a, b = plane.b, e = place.d;
  float area = KERNEL_VARIANCE * plane.det.z;
  float trace = KERNEL_VARIANCE * (dot(a, a) + dot(b, b));
  float det = area * area + view.filter_variance * (trace + view.filter_variance);
  // e V^-1 e det as squares: for edge-on or stretched splats, the differences in V^-1 lose all precision in float32.
  vec2 across = vec2(e.x * a.y - e.y * a.x, e.x * b.y - e.y * b.x);
  float rho2 = KERNEL_VARIANCE / det * (view.filter_variance * dot(e, e) + KERNEL_VARIANCE * dot(across, across));
  float weight = rho2 <= 1.0 ? abs(area) * inversesqrt(det) * exp(-2.0 * rho2) : 0.0;
  return vec2(weight, plane_depth(plane, place));
}
