// References: "View-independent object-space surface splatting", section 4.3 and equation 12.
// Summary: a splat as the quad of its two half-axes in space, and the kernel over it: a Gaussian of sigma 1/2, cut at the
//          ellipse.

// The corner of the splat's quad, in the space of its arguments.
vec3 footprint_corner(vec3 position, vec3 axis_u, vec3 axis_v, vec2 corner) {
  return position + axis_u * corner.x + axis_v * corner.y;
}

// The kernel at a place in units of the half-axes; 0 outside the ellipse, and for NaN.
float kernel_weight(vec2 place) {
  float rho2 = dot(place, place);
  return rho2 <= 1.0 ? exp(-2.0 * rho2) : 0.0;
}
