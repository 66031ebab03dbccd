// References: Guennebaud, Barthe, Paulin 2006, section 4: equations 8 to 10 (tangents lengthened until the splat is
//             as large as the pixel's filter), section 3: their projections exact and perspective; as printed by equations
//             5 and 6, else relative to the centre.
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
// Equations 4 and 6: the adjoint of the map whose columns are the half-axes and the centre, seen by this pixel and scaled
// so that w is 1 / depth. The paper's w is b times that, to which equation 7 adds a: the depth in the window. Here depths
// are compared along the view, so that b and a would be taken off again, and digits with them.
vec3 by_adjoint(Plane plane, vec2 pixel) {
  vec2 unit = view.window.zw, center = view.window.xy + plane.center * unit;
  vec3 s = plane.depth * vec3(plane.a * unit + center * plane.gh.x, plane.gh.x);
  vec3 t = plane.depth * vec3(plane.b * unit + center * plane.gh.y, plane.gh.y);
  vec3 p = plane.depth * vec3(center, 1.0), third = cross(s, t);
  return vec3(view.window.xy + pixel * unit, 1.0) * mat3(cross(t, p), cross(p, s), third) / dot(third, p);
}

vec2 printed_sample(Plane plane, vec2 pixel) {
  vec3 uvw = by_adjoint(plane, pixel);
  vec2 uv = uvw.xy / uvw.z;
  float rho2 = dot(uv, uv);
  return vec2(rho2 <= 1.0 && uvw.z > 0.0 ? exp(-2.0 * rho2) : 0.0, 1.0 / uvw.z);
}

// Weight and depth. Equation 6 is of perspective views alone.
vec2 splat_sample(Plane plane, vec2 pixel) {
  if (AS_PRINTED && view.is_parallel < 0.5) return printed_sample(plane, pixel);
  Place place = place_at(plane, pixel);
  float rho2 = dot(place.uv, place.uv);
  return vec2(rho2 <= 1.0 && place.k > 0.0 ? exp(-2.0 * rho2) : 0.0, plane_depth(plane, place));
}
