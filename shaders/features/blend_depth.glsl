// References: Botsch et al. 2005, section 3 (splats within epsilon blend); this project (a depth for each splat).
// Summary: a splat is moved back until its plane lies its blend depth behind its original plane, but by no more than
//          epsilon; its back then has the same weight as its front. Shadow maps always use epsilon, because surfaces
//          would shadow themselves otherwise. Large surfels are known by their blend depths (large_surfels.py). Twins:
//          visible_depth in reference/rays.py, side_weight and grain in reference/splats.py.

#part splat
float blended;  // of the splat that was fetched last, in longer half-axes

void blend_depth_unpack(inout StoredSplat stored, int index) {
  blended = take_blend_depth(stored, index);
}

#part splat, limits
// Backs with a blend depth do not occupy the place of fronts, so fronts need no precedence.
void blend_depth_hide(inout Splat splat) {
  if (blended < 1.0) splat.side_weight = 1.0;
  splat.grain = min((blended * float(BLEND_STEPS) - 0.5) / (float(STEPS_OF_SAMPLES) - 0.5), 1.0);
  if (splat.grain < 0.9) splat.side_weight *= LARGE_WEIGHT;
}

#part visibility.vert, moves_less
void blend_depth_blend(Splat splat, vec3 eye, inout float offset) {
  float radius = sqrt(max(dot(splat.axis_u, splat.axis_u), dot(splat.axis_v, splat.axis_v)));
  vec3 ray = view.is_parallel > 0.5 ? vec3(0.0, 0.0, 1.0) : eye, across = cross(splat.axis_u, splat.axis_v);
  float cosine = abs(dot(across, ray)) / max(length(across) * length(ray), 1e-37);
  offset = min(offset, blended * radius / max(cosine, 1e-6));
}
