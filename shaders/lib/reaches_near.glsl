// References: none needed.
// Summary: whether a splat reaches the near plane, where the projection of its ellipse is undefined.

bool reaches_near(Splat splat) {
  return -splat.position.z - length(vec2(splat.axis_u.z, splat.axis_v.z)) <= view.near;
}
