// References: Guennebaud, Barthe, Paulin 2006, section 4: equations 8 to 10 (tangents lengthened until the splat is
//             as large as the pixel's filter), section 3: their projections exact and perspective.
// Summary: the tangents are the half-axes of the splat's ellipse that are perpendicular in the picture, which exist for
//          every splat; depths remain those of its plane. The twin of reference/methods/homogeneous.py.

#include "lib/homogeneous.glsl"

#part vertex
#include "lib/principal_places.glsl"

void adjust(inout Splat splat, inout Plane plane, bool is_orthographic) {
  vec2 lengths2;
  mat2 places = principal_places(plane.a, plane.b, plane.det.z, lengths2);
  vec3 axis_u = splat.axis_u, axis_v = splat.axis_v;
  splat.axis_u = axis_u * places[0].x + axis_v * places[0].y;
  splat.axis_v = axis_u * places[1].x + axis_v * places[1].y;
  Plane adjusted = lengthened(splat, is_orthographic);
  adjusted.slope = depth_gradient(plane) * mat2(adjusted.a, adjusted.b);
  adjusted.reach = plane.radius;
  plane = adjusted;
}
#part fragment
// Weight and depth.
vec2 splat_sample(Plane plane, vec2 pixel) {
  Place place = place_at(plane, pixel);
  float rho2 = dot(place.uv, place.uv);
  return vec2(rho2 <= 1.0 && place.k > 0.0 ? exp(-2.0 * rho2) : 0.0, plane_depth(plane, place));
}
