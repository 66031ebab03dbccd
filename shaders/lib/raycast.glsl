// References: Botsch, Hornung, Zwicker, Kobbelt 2005, section 3 (ray casting a splat; its fragments are those of a square) and
//             section 5 (the union of the kernel and the pixel's low-pass as an approximation of EWA).
// Summary: the exact position in the ellipse, or the distance from the centre in pixels if that is smaller. The
//          includer defines AS_PRINTED.

const float FOOTPRINT_END = 1.0;
const float LOW_PASS_RADIUS = 1.41421356;  // of the screen-space filter, in pixels
const float OVER_RIM = 0.25;  // in radii: how far from the depths of the ellipse what the low-pass adds may be

// Half the side of the paper's square, in pixels: that of the bounding sphere if it were on the axis, at least 1.
float half_square(Plane plane) {
  float scale = view.is_parallel > 0.5 ? 1.0 : 1.0 / plane.depth;
  return max(plane.radius * scale / min(view.window.z, view.window.w), 1.0);
}

#part vertex
// Beyond the ellipse the paper's depths are those of the plane, as near as that comes.
void adjust(inout Splat splat, inout Plane plane, bool is_orthographic) {
  plane.reach = AS_PRINTED ? plane.depth - view.near : min(plane.reach, length(plane.slope) + OVER_RIM * plane.radius);
}

// The ellipse and the low-pass disc of sqrt(2) pixels around the splat's centre.
vec2 footprint(Plane plane, vec2 size, inout vec2 middle) {
  if (AS_PRINTED) {
    middle = plane.center;
    return vec2(1.45 * half_square(plane));
  }
  return 1.05 * max(size, vec2(LOW_PASS_RADIUS)) + length(plane.center - middle);
}
#part fragment
// Weight and depth: that of the plane, held near the ellipse where only the low-pass reaches, or as printed not held.
vec2 splat_sample(Plane plane, vec2 pixel) {
  Place place = place_at(plane, pixel);
  float inside = dot(place.uv, place.uv);
  bool is_inside = inside <= 1.0 && place.k > 0.0;
  float rho2 = min(is_inside ? inside : 2.0, 0.5 * dot(place.d, place.d));
  bool is_drawn = !AS_PRINTED || (max(abs(place.d.x), abs(place.d.y)) <= half_square(plane) && place.k > 0.0);
  float depth = AS_PRINTED ? plane.depth + dot(plane.slope, place.uv) : plane_depth(plane, place);
  return vec2(is_drawn && rho2 <= 1.0 ? exp(-2.0 * rho2) : 0.0, depth);
}
