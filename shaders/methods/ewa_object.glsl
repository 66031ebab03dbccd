// References: Ren, Pfister, Zwicker, "Object Space EWA Surface Splatting", 2002, as the view-independent paper has it in
//             section 3, equations 8 to 10; the amplitude that keeps the integral: Yu et al., "Mip-Splatting", 2024.
// Summary: the pixel's Gaussian is mapped to the splat's plane by the derivative of the projection at its centre and
//          combined with the kernel there, giving a larger quad for the hardware to draw. A quad that reaches the near
//          plane stays unchanged. The twin of reference/methods/ewa_object.py.

#include "lib/surfel_quad.glsl"

#part vertex
#include "lib/kernel_variance.glsl"
#include "lib/plane.glsl"
#include "lib/principal_places.glsl"
#include "lib/reaches_near.glsl"

const float LEAST_FLATNESS2 = 0.004;  // flatter than 1 : 16, splats are not widened further, or quads would have no end
const float ANY = 3e38;
const float LEAST_DEPTH = 1e-3;       // relative to the splat's: quads are not drawn nearer to the eye's plane

// The combined half-axes; their columns in terms of the splat's own are returned.
mat2 widen(inout Splat splat) {
  depth_reach = vec3(-splat.position.z, vec2(ANY));
  if (reaches_near(splat)) return mat2(1.0);
  Plane plane = splat_plane(splat.position, splat.axis_u, splat.axis_v, view.is_parallel > 0.5);
  depth_reach.yz = vec2(plane.reach, length(plane.slope));
  vec2 lengths2;
  mat2 along = principal_places(plane.a, plane.b, plane.det.z, lengths2);
  vec2 both = KERNEL_VARIANCE * lengths2 + view.filter_variance;
  splat.amplitude = KERNEL_VARIANCE * abs(plane.det.z) * inversesqrt(both.x * both.y);
  lengths2.y = max(lengths2.y, LEAST_FLATNESS2 * lengths2.x);
  vec2 half_axes = 2.0 * sqrt(KERNEL_VARIANCE + view.filter_variance / max(lengths2, vec2(1e-30)));
  mat2 joined = mat2(along[0] * half_axes.x, along[1] * half_axes.y);
  vec3 axis_u = splat.axis_u, axis_v = splat.axis_v;
  splat.axis_u = axis_u * joined[0].x + axis_v * joined[0].y;
  splat.axis_v = axis_u * joined[1].x + axis_v * joined[1].y;
  return joined;
}

// The clip range is that of the original splats: enlarged quads that exceed it are drawn anyway, at the depth that
// their fragments write. The hardware clips a quad only where it reaches behind the eye, and one that is not enlarged
// at the near plane.
vec4 quad_corner(Splat splat, vec3 eye) {
  vec4 corner = view.projection * vec4(eye, 1.0);
  float nearest = depth_reach.y == ANY ? view.near : LEAST_DEPTH * depth_reach.x;
  corner.z = view.is_parallel > 0.5 ? 0.0 : corner.w - 2.0 * nearest;
  return corner;
}

#part fragment
// The depth of the splat's plane, held near the splat, as in screen space: where a filter reaches over a silhouette, the
// plane runs to the eye.
float seen_depth() {
  return clamp(place_depth.z, depth_reach.x - depth_reach.y, depth_reach.x + depth_reach.y);
}

// Where a filter reaches over its rim, a splat is in the layers that the rim itself is in.
float layer_depth() {
  return clamp(place_depth.z, depth_reach.x - depth_reach.z, depth_reach.x + depth_reach.z);
}
