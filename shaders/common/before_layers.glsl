// References: Guennebaud, Barthe, Paulin 2006, section 6.
// Summary: puts what transparent layers add up to in the pixel before the opaque picture, of which they let through the
//          part that is given: premultiplied colour, normal and coverage, nearest depth.

void put_layers_before(inout vec4 color, inout vec4 normal, inout float nearest) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 before = texelFetch(layers, pixel, 0);
  float depth_before = texelFetch(layers_depth, pixel, 0).r;
  color += before;
  normal.w += before.w;
#ifdef NORMAL_COVERAGE_OUTPUT
  normal.xyz += texelFetch(layers_normal, pixel, 0).xyz;
#endif
  if (depth_before > 0.0) nearest = min(nearest, depth_before);
}
