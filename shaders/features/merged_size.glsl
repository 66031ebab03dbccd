// References: Zwicker, Pfister, van Baar, Gross, "EWA Splatting", 2002 (a kernel's and a filter's variances add up).
// Summary: merged splats overlap by so much that coarse levels have no holes. Where they are about as small as a pixel,
//          its filter blends them, too, and the same overlap would blur the picture and protrude at silhouettes. They
//          are narrower there by what the filter adds. They overlap less than samples, and therefore weigh more.

#part splat
void merged_size_resize(inout Splat splat, int index) {
  if (float(index) < draw.first_merged) return;
  float sample_size = view.window.w * (view.is_parallel > 0.5 ? 1.0 : -splat.position.z);
  float square = max(dot(splat.axis_u, splat.axis_u), dot(splat.axis_v, splat.axis_v));
  float filter_square = 4.0 * view.filter_variance * sample_size * sample_size;
  float scale = sqrt(max(1.0 - filter_square / max(square, 1e-37), LEAST_SHOWN));
  splat.axis_u *= scale;
  splat.axis_v *= scale;
  splat.shortened = scale;
  splat.side_weight *= MERGED_WEIGHT;
}
