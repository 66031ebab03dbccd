// References: "View-independent object-space surface splatting", section 4 (surfel quads, the hardware's
//             perspective-correct interpolation) and equation 12 (the kernel without a low-pass filter).
// Summary: a splat is the quad of its two half-axes in space, clipped by the hardware. The pixel's place in the
//          ellipse is interpolated; the kernel is a Gaussian of sigma 1/2, cut at the ellipse.
//          The twin of reference/methods/quad.py.

// The corner of the splat's quad, in the space of its arguments.
vec3 footprint_corner(vec3 position, vec3 axis_u, vec3 axis_v, vec2 corner) {
  return position + axis_u * corner.x + axis_v * corner.y;
}

// The kernel at a place in units of the half-axes; 0 outside the ellipse, and for NaN.
float kernel_weight(vec2 place) {
  float rho2 = dot(place, place);
  return rho2 <= 1.0 ? exp(-2.0 * rho2) : 0.0;
}
