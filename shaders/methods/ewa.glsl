// References: Zwicker, Pfister, van Baar, Gross, "Surface Splatting", 2001, equations 9 to 12; Ren et al. 2002; the
//             amplitude that keeps the integral: Yu et al., "Mip-Splatting", 2024.
// Summary: the classic yardstick: the splat's projection is taken as affine at its centre, and joined with the
//          pixel's Gaussian in the picture. The twin of rendering/methods/ewa.py.

const float KERNEL_VARIANCE = 0.25;
const float FILTER_SIGMA = 0.70710678;  // pixels
const float FILTER_VARIANCE = FILTER_SIGMA * FILTER_SIGMA;

#ifdef VERTEX_STAGE
void adjust(inout Splat splat, bool straddles) {}

// Only what the exact box covers: the affine ellipse of a near splat can fill the picture.
vec2 footprint_box(Plane plane, out vec2 middle) {
  return projected_box(plane, middle) + 2.0 * FILTER_SIGMA * splats.window.zw;
}
#else
// Weight and depth.
vec2 splat_sample(Plane plane, vec2 point) {
  Place place = place_at(plane, point);
  vec2 a = plane.a / splats.window.zw, b = plane.b / splats.window.zw, e = place.d / splats.window.zw;
  float xx = KERNEL_VARIANCE * (a.x * a.x + b.x * b.x) + FILTER_VARIANCE;
  float yy = KERNEL_VARIANCE * (a.y * a.y + b.y * b.y) + FILTER_VARIANCE;
  float xy = KERNEL_VARIANCE * (a.x * a.y + b.x * b.y);
  float area = KERNEL_VARIANCE * (a.x * b.y - a.y * b.x);
  float det = area * area + FILTER_VARIANCE * (xx + yy - FILTER_VARIANCE);
  float rho2 = KERNEL_VARIANCE / det * (e.x * e.x * yy - 2.0 * e.x * e.y * xy + e.y * e.y * xx);
  float weight = rho2 <= 1.0 ? abs(area) * inversesqrt(det) * exp(-2.0 * rho2) : 0.0;
  return vec2(weight, plane_depth(plane, place, FILTER_SIGMA));
}
#endif
