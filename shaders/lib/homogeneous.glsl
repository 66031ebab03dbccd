// References: Guennebaud, Barthe, Paulin 2006, section 4.1: equations 8 and 9 (tangents lengthened until the splat is as
//             large as the pixel's filter).
// Summary: a half-axis shorter than sqrt(2) pixels in the picture is replaced by one of that length parallel to the
//          picture.

const float FILTER_RADIUS = 1.41421356;  // pixels

const float FOOTPRINT_END = 1.0;

#part vertex
// Half-axis `axis`, lengthened to the filter's size in the picture.
vec3 at_least_filter(vec3 axis, vec3 position, bool is_orthographic) {
  vec2 pixel = view.window.zw;
  float depth = is_orthographic ? 1.0 : -position.z;
  vec2 across = is_orthographic ? axis.xy : (axis.xy * depth + axis.z * position.xy) / (depth * depth - axis.z * axis.z);
  vec2 pixels = across / pixel;
  float size = length(pixels);
  return size < FILTER_RADIUS && size > 0.0 ? vec3(pixels / size * FILTER_RADIUS * pixel * depth, 0.0) : axis;
}

// The plane of the splat once both half-axes are long enough.
Plane lengthened(inout Splat splat, bool is_orthographic) {
  splat.axis_u = at_least_filter(splat.axis_u, splat.position, is_orthographic);
  splat.axis_v = at_least_filter(splat.axis_v, splat.position, is_orthographic);
  return splat_plane(splat.position, splat.axis_u, splat.axis_v, is_orthographic);
}

vec2 footprint(Plane plane, vec2 size, inout vec2 middle) {
  return 1.01 * size;
}
