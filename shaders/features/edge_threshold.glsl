// References: the view-independent paper, section 4.5.
// Summary: samples fade where the sum of the splats' weights is below a threshold.

#part shaded_sample
void edge_threshold_finish(inout Shaded s) {
  if (s.mean.polygon == 0.0) s.coverage *= min(front_weight(s.mean.weight) / frame.edge_threshold, 1.0);
}
