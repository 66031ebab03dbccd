// References: "View-independent object-space surface splatting", sections 4.1 to 4.3 (surfel quads, the hardware's
//             perspective-correct interpolation) and equation 12 (the kernel without a low-pass filter).
// Summary: a splat is the quad of its two half-axes in space, clipped by the hardware, with interpolated positions in
//          the ellipse. The twin of reference/methods/quad.py.

#include "lib/surfel_quad.glsl"

#part vertex
// Half-axes remain unchanged.
mat2 widen(inout Splat splat) {
  return mat2(1.0);
}

vec4 quad_corner(Splat splat, vec3 eye) {
  return view.projection * vec4(eye, 1.0);
}

#part fragment
float seen_depth() {
  return place_depth.z;
}

float layer_depth() {
  return place_depth.z;
}
