// References: Guennebaud, Barthe, Paulin 2006, section 3 (the plane's homography); written relative to the splat's
//             centre, of which places and depths are then changes.
// Summary: maps points of the picture to positions in a splat's plane, for perspective and parallel cameras. The twin
//          of reference/methods/plane.py.

struct Plane {
  vec2 center;   // of the splat in the picture
  vec2 a;        // image of one half-axis u, v
  vec2 b;
  vec2 gh;       // relative change of depth along u, v; 0 for parallel cameras
  vec2 slope;    // change of depth along u, v
  float depth;
  float reach;   // range of depths around the centre: within the ellipse, plus the filter's reach beyond its rim
  float radius;  // the longer half-axis
  vec3 det;      // of the map from the picture to the plane, times depth at the centre over depth: det.z - d . det.xy
};

// Length of a pixel at the splat's centre.
float pixel_length(Plane plane) {
  return view.window.z * (view.is_parallel > 0.5 ? 1.0 : plane.depth);
}

// Beyond a concave crease the filter reaches into a face that is nearer, by at most this.
float most_nearer(Plane plane) {
  return (1.0 + 4.0 * draw.epsilon) * plane.radius + 4.0 * pixel_length(plane);
}

#part vertex
// Change of depth per pixel, at the centre.
vec2 depth_gradient(Plane plane) {
  vec2 a = plane.a, b = plane.b, slope = plane.slope;
  return vec2(slope.x * b.y - slope.y * a.y, slope.y * a.x - slope.x * b.x) / plane.det.z;
}

Plane splat_plane(vec3 position, vec3 axis_u, vec3 axis_v, bool is_orthographic) {
  Plane plane;
  plane.depth = -position.z;
  plane.slope = -vec2(axis_u.z, axis_v.z);
  float scale = is_orthographic ? 1.0 : 1.0 / plane.depth;
  vec2 center = position.xy * scale, pixel = view.window.zw;
  plane.center = (center - view.window.xy) / pixel;
  plane.gh = is_orthographic ? vec2(0.0) : plane.slope * scale;
  plane.a = (axis_u.xy * scale - center * plane.gh.x) / pixel;
  plane.b = (axis_v.xy * scale - center * plane.gh.y) / pixel;
  plane.det = vec3(plane.gh.x * plane.b.y - plane.gh.y * plane.a.y, plane.gh.y * plane.a.x - plane.gh.x * plane.b.x,
                   plane.a.x * plane.b.y - plane.a.y * plane.b.x);
  plane.radius = sqrt(max(dot(axis_u, axis_u), dot(axis_v, axis_v)));
  float over_rim = 2.0 * sqrt(view.filter_variance) * length(depth_gradient(plane)), furthest = 16.0 * plane.radius;
  plane.reach = length(plane.slope) + (over_rim < furthest ? over_rim : furthest);
  return plane;
}

// Half-axes of the splat's projection, the longer first, their lengths in `size`, and its centre in `middle`;
// exact for an ellipse before the eye.
mat2 projected_ellipse(Plane plane, out vec2 size, out vec2 middle) {
  float d = 1.0 - dot(plane.gh, plane.gh);
  vec2 c = -(plane.a * plane.gh.x + plane.b * plane.gh.y) / d;
  middle = plane.center + c;
  vec2 a = plane.a * inversesqrt(d), b = plane.b * inversesqrt(d);
  vec2 on = a * a + b * b + c * c;
  float across = a.x * a.y + b.x * b.y + c.x * c.y;
  // The determinant by the Cauchy-Binet formula, which has no cancellation.
  vec3 areas = vec3(a.x * b.y - a.y * b.x, a.x * c.y - a.y * c.x, b.x * c.y - b.y * c.x);
  float half_difference = 0.5 * (on.x - on.y), apart = length(vec2(half_difference, across));
  float longer = 0.5 * (on.x + on.y) + apart;
  size = sqrt(vec2(longer, dot(areas, areas) / max(longer, 1e-37)));
  vec2 along = half_difference > 0.0 ? vec2(half_difference + apart, across) : vec2(across, apart - half_difference);
  along = dot(along, along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  return mat2(along, -along.y, along.x);
}

// No method moves any part of the splat closer than this.
float nearest_depth(Plane plane) {
  return max(plane.depth - max(plane.reach, plane.radius), view.near);
}
