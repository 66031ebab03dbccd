// References: Zwicker et al. 2001 (the resampling filter), taken to the splat's plane with the exact Jacobian of
//             every pixel, in the style of AA-2DGS (arXiv 2506.11252); this project.
// Summary: the pixel's Gaussian is mapped into the splat's plane, joined with the kernel there and scaled to keep
//          its integral: neither a vanishing splat nor a stretched one loses or gains weight. The kernel's rim is
//          blurred as much as the pixel's Gaussian blurs it: where splats are larger than pixels, nothing else is.
//          The twin of rendering/methods/mip.py.

const float KERNEL_VARIANCE = 0.25;
const float FILTER_VARIANCE = 0.5;  // square pixels
const vec2 NORMAL = vec2(1.5976, 0.070565);  // 1 / (1 + exp(-x (NORMAL.x + NORMAL.y x^2))) is within 2e-4 of it

#ifdef VERTEX_STAGE
void adjust(inout Splat splat, inout Plane plane, bool is_orthographic) {}

// Beyond 2 sigma of kernel and filter, and 1 pixel from the splat's rim, nothing counts.
vec2 footprint(Plane plane, vec2 size, inout vec2 middle) {
  return max(sqrt(size * size + 1.5 * 1.5), size + 1.0);
}
#else
// Weight and depth.
vec2 splat_sample(Plane plane, vec2 point) {
  Place place = place_at(plane, point);
  mat2 j = place_gradient(plane, place);
  vec2 q = place.uv, pixel = splats.window.zw;
  // det J and q x J, multiplied out: edge-on, the differences that they stand for have no digits left in float32.
  float scale = place.k / place.det;
  float spread = FILTER_VARIANCE * place.k * scale * pixel.x * pixel.y;
  vec2 across = scale * pixel * place.d.yx;
  float det = spread * spread
      + KERNEL_VARIANCE * (FILTER_VARIANCE * (dot(j[0], j[0]) + dot(j[1], j[1])) + KERNEL_VARIANCE);
  float amplitude = inversesqrt(det);
  float rho2 = KERNEL_VARIANCE * amplitude * amplitude
      * (KERNEL_VARIANCE * dot(q, q) + FILTER_VARIANCE * dot(across, across));
  // The kernel ends at its rim. Along the line from the centre, kernel times pixel is a Gaussian about share of
  // the way: what of it lies within the rim, its normal distribution, is what the pixel sees of the splat.
  float reach2 = max(dot(q, q), 1e-30);
  vec2 across_rim = q * j;
  float along = FILTER_VARIANCE * dot(across_rim, across_rim) / reach2;
  float share = KERNEL_VARIANCE / (KERNEL_VARIANCE + along);
  float x = clamp((sqrt(reach2) * share - 1.0) * inversesqrt(max(along * share, 1e-12)), -8.0, 8.0);
  float weight = KERNEL_VARIANCE * amplitude * exp(-2.0 * rho2) / (1.0 + exp(x * (NORMAL.x + NORMAL.y * x * x)));
  return vec2(place.k > 0.0 ? weight : 0.0, plane_depth(plane, place));
}
#endif
