// References: as plane.glsl.
// Summary: the pixel's position in a splat's plane, its derivative per pixel, and the depth there.

#include "lib/plane.glsl"

struct Place {
  vec2 uv;
  float k;      // depth here over depth at the centre (perspective)
  float scale;  // k / det
  vec2 d;       // from the centre, in the picture
};

Place place_at(Plane plane, vec2 pixel) {
  Place place;
  vec2 d = pixel - plane.center;
  place.d = d;
  float over_det = 1.0 / (plane.det.z - dot(d, plane.det.xy));
  place.uv = vec2(d.x * plane.b.y - d.y * plane.b.x, plane.a.x * d.y - plane.a.y * d.x) * over_det;
  place.k = plane.det.z * over_det;
  place.scale = place.k * over_det;
  return place;
}

// d(u, v) / d(pixel) over place.scale: columns are the derivatives along x and y.
mat2 place_turn(Plane plane, Place place) {
  return mat2(plane.b.y - plane.gh.y * place.d.y, plane.gh.x * place.d.y - plane.a.y,
              plane.gh.y * place.d.x - plane.b.x, plane.a.x - plane.gh.x * place.d.x);
}

// Depth of the splat's plane, clamped near the splat: outside the ellipse the plane continues to the horizon.
float plane_depth(Plane plane, Place place) {
  float offset = clamp(dot(plane.slope, place.uv), -plane.reach, plane.reach);
  return plane.depth + (place.k > 0.0 ? offset : 0.0);
}
