// References: Botsch, Kobbelt, "High-Quality Point-Based Rendering on Modern GPUs", 2003, sections 3.1 (the size of the
//             sprite), 3.2 (the depth offset of the disc's plane bounds its ellipse) and 3.3 (the kernel, the corrected depth).
// Summary: discs only; the offset in the picture, in radii, and the depth offset of the plane there make the place.
//          The twin of reference/methods/sprites.py.

const float LEAST_COSINE = 0.1;  // a disc seen flatter is drawn as one seen at this angle

const float FOOTPRINT_END = 1.0;

#part vertex
void adjust(inout Splat splat, inout Plane plane, bool is_orthographic) {}

vec2 footprint(Plane plane, vec2 size, inout vec2 middle) {
  float scale = view.is_parallel > 0.5 ? 1.0 : 1.0 / plane.depth;
  middle = plane.center;
  return vec2(1.01 * plane.radius * scale / min(view.window.z, view.window.w));
}
#part fragment
// Weight and depth.
vec2 splat_sample(Plane plane, vec2 pixel) {
  float scale = view.is_parallel > 0.5 ? 1.0 : 1.0 / plane.depth;
  float radius = plane.radius;
  vec2 unit = view.window.zw, center = view.window.xy + plane.center * unit;
  vec3 axis_u = vec3((plane.a * unit + center * plane.gh.x) / scale, -plane.slope.x);
  vec3 axis_v = vec3((plane.b * unit + center * plane.gh.y) / scale, -plane.slope.y);
  vec3 disc = normalize(cross(axis_u, axis_v));
  disc *= disc.z < 0.0 ? -1.0 : 1.0;
  vec2 q = (pixel - plane.center) * unit / (radius * scale);
  float offset = -dot(disc.xy, q) / max(disc.z, LEAST_COSINE);
  float rho2 = dot(q, q) + offset * offset;
  return vec2(rho2 <= 1.0 ? exp(-2.0 * rho2) : 0.0, plane.depth - radius * offset);
}
