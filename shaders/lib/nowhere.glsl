// References: none needed.
// Summary: the position of all corners of what is skipped, so that it has no area: where its middle would be. A software
//          rasterizer clips all triangles of a batch if one corner of them is outside the view volume, so skipped ones
//          must not be outside unless their neighbours are, too.

vec4 nowhere(vec3 eye) {
  return view.projection * vec4(eye, 1.0);
}
