// References: Botsch, Kobbelt 2003, sections 3.1 (the size of the sprite), 3.2 (the depth offset of the disc's plane bounds its
//             ellipse) and 3.3 (the kernel and the corrected depth, of visibility and attributes alike).
// Summary: discs only; the offset in the picture, in radii, and the depth offset of the plane give the position. The
//          includer defines AS_PRINTED.

#include "lib/disc_in_sprite.glsl"

const float FOOTPRINT_END = 1.0;

// Half the side of the sprite, in radii at the splat's centre. Equation 1 is the projection of one radius, and the square
// has it for its whole side.
const float HALF_SIDE = AS_PRINTED ? 0.5 : 1.0;

// Equation 4 adds the offset of equation 2 to the distance. That offset is in radii and towards the viewer. As printed,
// it is added unchanged, in scene units; corrected, this number of radii is subtracted.
float sprite_depth(float depth, float radius, float offset) {
  return AS_PRINTED ? depth + offset / view.world_length : depth - radius * offset;
}

#part vertex
void adjust(inout Splat splat, inout Plane plane, bool is_orthographic) {
  if (AS_PRINTED) plane.reach = plane.depth - view.near;  // an offset in scene units reaches anywhere
}

vec2 footprint(Plane plane, vec2 size, inout vec2 middle) {
  float scale = view.is_parallel > 0.5 ? 1.0 : 1.0 / plane.depth;
  middle = plane.center;
  return vec2(1.01 * HALF_SIDE * plane.radius * scale / min(view.window.z, view.window.w));
}
#part fragment
// As printed, equation 4 is below 0 up to twice the near plane's distance, because its b is twice the right one. The
// window has nothing below 0: all that lies there is in the near plane, and hides nothing else there.
float window_depth(float depth) {
  bool is_clamped = AS_PRINTED && view.is_parallel < 0.5 && depth > 0.0 && depth < 2.0 * view.near;
  return is_clamped ? view.near : depth;
}

// Weight and depth.
vec2 splat_sample(Plane plane, vec2 pixel) {
  float scale = view.is_parallel > 0.5 ? 1.0 : 1.0 / plane.depth;
  vec2 unit = view.window.zw, center = view.window.xy + plane.center * unit;
  vec3 axis_u = vec3((plane.a * unit + center * plane.gh.x) / scale, -plane.slope.x);
  vec3 axis_v = vec3((plane.b * unit + center * plane.gh.y) / scale, -plane.slope.y);
  vec2 q = (pixel - plane.center) * unit / (HALF_SIDE * plane.radius * scale);
  float offset = dot(sprite_tilt(axis_u, axis_v), q);
  float rho2 = dot(q, q) + offset * offset;
  return vec2(rho2 <= 1.0 ? exp(-2.0 * rho2) : 0.0, window_depth(sprite_depth(plane.depth, plane.radius, offset)));
}
