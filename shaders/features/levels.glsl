// References: Dachsbacher, Vogelgsang, Stamminger, "Sequential Point Trees", SIGGRAPH 2003 (levels in one array, of which
//             a view draws some); rendering/upload/cuts.py, which writes the numbers.
// Summary: finds the splat of a triangle if a view draws only some of the stored splats. Merged ones overlap by so much
//          that coarse levels have no holes. Where they are about as small as a pixel, its filter blends them, too, and
//          the same overlap would blur the picture and protrude at silhouettes, so they are drawn smaller.

#part splat
const float LEAST_SQUARE = 0.66;   // of how much smaller: smaller ones would leave gaps at the corners of their cells
const float FILTER_SQUARE = 2.0;   // pixels, of the half-axis of a kernel with the variance of the pixel's filter

bool is_merged;  // of the splat that was fetched last

void levels_choose(inout int index) {
  float number = texelFetch(drawn_splats, ivec2(index % NUMBERS_PER_ROW, index / NUMBERS_PER_ROW), 0).r;
  is_merged = number < 0.0;
  index = int(is_merged ? -1.0 - number : number);
}

void levels_resize(inout Splat splat) {
  if (!is_merged) return;
  float pixel = view.window.w * (view.is_parallel > 0.5 ? 1.0 : -splat.position.z);
  float radius = max(dot(splat.axis_u, splat.axis_u), dot(splat.axis_v, splat.axis_v));
  float smaller = sqrt(max(1.0 - FILTER_SQUARE * pixel * pixel / max(radius, 1e-37), LEAST_SQUARE));
  splat.axis_u *= smaller;
  splat.axis_v *= smaller;
}
