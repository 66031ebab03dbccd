// References: Guennebaud, Barthe, Paulin 2006, section 4: equations 8 to 10 (tangents lengthened until the splat is
//             as large as the pixel's filter), section 3: their projections exact and perspective.
// Summary: a half-axis shorter than sqrt(2) pixels in the picture is replaced by one of that length parallel to the
//          picture; then the kernel is evaluated as usual. The includer defines AS_PRINTED.

const float FILTER_RADIUS = 1.41421356;  // pixels

const float FOOTPRINT_END = 1.0;

#part vertex
#include "lib/principal_places.glsl"

// Half-axis `axis`, lengthened to the filter's size in the picture.
vec3 at_least_filter(vec3 axis, vec3 position, bool is_orthographic) {
  vec2 pixel = view.window.zw;
  float depth = is_orthographic ? 1.0 : -position.z;
  vec2 across = is_orthographic ? axis.xy : (axis.xy * depth + axis.z * position.xy) / (depth * depth - axis.z * axis.z);
  vec2 pixels = across / pixel;
  float size = length(pixels);
  return size < FILTER_RADIUS && size > 0.0 ? vec3(pixels / size * FILTER_RADIUS * pixel * depth, 0.0) : axis;
}

// The paper's tangents, for discs only: across the ray and along it, about perpendicular in the picture. As printed,
// those of a disc that faces the ray are 0 / 0, and replacing a tangent changes depths. Repaired, they are the
// half-axes of the splat's ellipse (section 3) that are perpendicular in the picture, which exist for every splat;
// depths remain those of its plane.
void adjust(inout Splat splat, inout Plane plane, bool is_orthographic) {
  if (AS_PRINTED) {
    vec3 normal_to_plane = normalize(cross(splat.axis_u, splat.axis_v));
    vec3 across = cross(is_orthographic ? vec3(0.0, 0.0, -1.0) : splat.position, normal_to_plane);
    splat.axis_u = plane.radius * normalize(across);
    splat.axis_v = plane.radius * normalize(cross(normal_to_plane, across));
  } else {
    vec2 lengths2;
    mat2 places = principal_places(plane.a, plane.b, plane.det.z, lengths2);
    vec3 axis_u = splat.axis_u, axis_v = splat.axis_v;
    splat.axis_u = axis_u * places[0].x + axis_v * places[0].y;
    splat.axis_v = axis_u * places[1].x + axis_v * places[1].y;
  }
  splat.axis_u = at_least_filter(splat.axis_u, splat.position, is_orthographic);
  splat.axis_v = at_least_filter(splat.axis_v, splat.position, is_orthographic);
  Plane adjusted = splat_plane(splat.position, splat.axis_u, splat.axis_v, is_orthographic);
  if (!AS_PRINTED) {
    adjusted.slope = depth_gradient(plane) * mat2(adjusted.a, adjusted.b);
    adjusted.reach = plane.radius;
  }
  plane = adjusted;
}

vec2 footprint(Plane plane, vec2 size, inout vec2 middle) {
  return 1.01 * size;
}
#part fragment
// Weight and depth.
vec2 splat_sample(Plane plane, vec2 pixel) {
  Place place = place_at(plane, pixel);
  float rho2 = dot(place.uv, place.uv);
  return vec2(rho2 <= 1.0 && place.k > 0.0 ? exp(-2.0 * rho2) : 0.0, plane_depth(plane, place));
}
