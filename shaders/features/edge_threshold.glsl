// References: the view-independent paper, section 4.5.
// Summary: samples fade where the sum of the splats' weights is below a threshold; as printed they are not normalised
//          there, so that a sample is as opaque as its weights sum to.

#part shaded_sample, fades
void edge_threshold_finish(inout Shaded s) {
  if (s.mean.polygon == 0.0) s.coverage *= min(front_weight(s.mean.weight) / frame.edge_threshold, 1.0);
}

#part shaded_sample, printed_sums
void edge_threshold_finish(inout Shaded s) {
  float weight = front_weight(s.mean.weight);
  if (s.mean.polygon == 0.0 && weight < frame.edge_threshold) s.coverage *= min(weight, 1.0);
}
