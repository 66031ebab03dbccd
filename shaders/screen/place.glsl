// References: as plane.glsl.
// Summary: the pixel's place in a splat's plane, how it changes from pixel to pixel, and the depth there.

#include "screen/plane.glsl"

struct Place {
  vec2 uv;
  float k;    // depth here over depth at the centre (perspective)
  float det;
  vec2 d;     // from the centre, in the picture
};

vec2 picture_point() {
  return splats.window.xy + gl_FragCoord.xy * splats.window.zw;
}

Place place_at(Plane plane, vec2 point) {
  Place place;
  vec2 d = point - plane.center;
  place.d = d;
  place.det = plane.a.x * plane.b.y - plane.a.y * plane.b.x
      - d.x * (plane.gh.x * plane.b.y - plane.gh.y * plane.a.y)
      - d.y * (plane.gh.y * plane.a.x - plane.gh.x * plane.b.x);
  place.uv = vec2(d.x * plane.b.y - d.y * plane.b.x, plane.a.x * d.y - plane.a.y * d.x) * (1.0 / place.det);
  place.k = 1.0 + dot(plane.gh, place.uv);
  return place;
}

// d(u, v) / d(pixel): columns are the derivatives along x and y.
mat2 place_gradient(Plane plane, Place place) {
  float scale = place.k / place.det;
  vec2 along_x = vec2(plane.b.y - plane.gh.y * place.d.y, -(plane.a.y - plane.gh.x * place.d.y)) * scale;
  vec2 along_y = vec2(-(plane.b.x - plane.gh.y * place.d.x), plane.a.x - plane.gh.x * place.d.x) * scale;
  return mat2(along_x * splats.window.z, along_y * splats.window.w);
}

// Depth of the splat's plane, held near the splat: outside the ellipse the plane runs off to the horizon.
float plane_depth(Plane plane, Place place) {
  float offset = clamp(dot(plane.slope, place.uv), -plane.reach, plane.reach);
  return plane.depth + (place.k > 0.0 ? offset : 0.0);
}
