// References: Botsch, Hornung, Zwicker, Kobbelt 2005, section 3 (ray casting a splat) and section 5 (the union of the
//             kernel and the pixel's low-pass as an approximation of EWA).
// Summary: the exact place in the ellipse, or the distance from the centre in pixels if that is less.
//          The twin of reference/methods/raycast.py.

const float FOOTPRINT_END = 1.0;

#part vertex
void adjust(inout Splat splat, inout Plane plane, bool is_orthographic) {}

// The ellipse, and the low-pass's disc of sqrt(2) pixels, which lies around the splat's centre: beside the ellipse's.
vec2 footprint(Plane plane, vec2 size, inout vec2 middle) {
  return 1.05 * max(size, vec2(2.0 * FILTER_SIGMA)) + length(plane.center - middle);
}
#part fragment
// Weight and depth: the plane's inside the ellipse, the centre's where only the low-pass reaches.
vec2 splat_sample(Plane plane, vec2 pixel) {
  Place place = place_at(plane, pixel);
  float inside = dot(place.uv, place.uv);
  bool is_inside = inside <= 1.0 && place.k > 0.0;
  float rho2 = min(is_inside ? inside : 2.0, 0.5 * dot(place.d, place.d));
  float depth = plane.depth + (is_inside ? dot(plane.slope, place.uv) : 0.0);
  return vec2(rho2 <= 1.0 ? exp(-2.0 * rho2) : 0.0, depth);
}
