// References: Botsch et al. 2005, section 3 (splats within epsilon blend); this project (how far each needs to).
// Summary: a splat is moved back until its plane lies its blend depth behind itself, and by no more than its epsilon; its
//          back then weighs what a front does. In shadow maps epsilon alone counts, or surfaces would shadow themselves.
//          Its twins are visible_depth of reference/rays.py and side_weight of reference/splats.py.

#part splat
float blended;  // of the splat that was fetched last, in its longer half-axis

void blend_depth_unpack(inout StoredSplat stored, int index) {
  blended = take_blend_depth(stored, index);
}

// Backs that blend as deep as their own surface asks for lie in no front's place, and fronts need no help against them.
void blend_depth_hide(inout Splat splat) {
  if (blended < 1.0) splat.color_weight.w = 1.0;
}

#part visibility.vert, blends_less
void blend_depth_blend(Splat splat, vec3 eye, inout float offset) {
  float radius = sqrt(max(dot(splat.axis_u, splat.axis_u), dot(splat.axis_v, splat.axis_v)));
  vec3 ray = view.is_parallel > 0.5 ? vec3(0.0, 0.0, 1.0) : eye, across = cross(splat.axis_u, splat.axis_v);
  float cosine = abs(dot(across, ray)) / max(length(across) * length(ray), 1e-37);
  offset = min(offset, blended * radius / max(cosine, 1e-6));
}
