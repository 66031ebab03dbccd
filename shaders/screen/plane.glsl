// References: Guennebaud, Barthe, Paulin 2006, section 3 (the plane's homography); written relative to the splat's
//             centre, which keeps its digits for small and far splats where adj(M) loses them.
// Summary: from a point of the picture to the place in a splat's plane, for perspective and parallel cameras alike.
//          The twin of rendering/methods/homography.py.
//
// Depth z counts forwards. A picture point is x / z, y / z (perspective) or x, y (parallel), in units of the plane at
// distance 1; `splats.window` holds the lower left corner and the step of one pixel.

struct Plane {
  vec2 center;   // of the splat in the picture
  vec2 a;        // what one half-axis u, v moves it
  vec2 b;
  vec2 gh;       // relative change of depth along u, v; 0 for parallel cameras
  vec2 slope;    // change of depth along u, v
  float depth;
  vec2 gradient; // change of depth with the picture point, at the centre
  float radius;  // the longer half-axis
};

Plane splat_plane(vec3 position, vec3 axis_u, vec3 axis_v, bool is_orthographic) {
  Plane plane;
  plane.depth = -position.z;
  plane.slope = -vec2(axis_u.z, axis_v.z);
  float scale = is_orthographic ? 1.0 : 1.0 / plane.depth;
  plane.center = position.xy * scale;
  plane.gh = is_orthographic ? vec2(0.0) : plane.slope * scale;
  plane.a = axis_u.xy * scale - plane.center * plane.gh.x;
  plane.b = axis_v.xy * scale - plane.center * plane.gh.y;
  float det = plane.a.x * plane.b.y - plane.a.y * plane.b.x;
  plane.gradient = vec2(plane.slope.x * plane.b.y - plane.slope.y * plane.a.y,
                        plane.slope.y * plane.a.x - plane.slope.x * plane.b.x) / det;
  plane.radius = sqrt(max(dot(axis_u, axis_u), dot(axis_v, axis_v)));
  return plane;
}

// Half-size of the exact box of the ellipse in the picture, and its centre in `middle`; valid in front of the eye.
vec2 projected_box(Plane plane, out vec2 middle) {
  float d = 1.0 - dot(plane.gh, plane.gh);
  vec2 offset = -(plane.a * plane.gh.x + plane.b * plane.gh.y) / d;
  middle = plane.center + offset;
  return sqrt(offset * offset + (plane.a * plane.a + plane.b * plane.b) / d);
}
