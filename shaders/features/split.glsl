// References: Guennebaud et al. 2006, section 5 (polygons where they are large in the picture, splats elsewhere).
// Summary: for an object that is split by its distance from the camera: splats with centres closer than their limit are
//          not drawn, and neither are polygons beyond theirs. 0 means no limit.

float eye_distance(vec3 position) {
  return view.is_parallel > 0.5 ? -position.z : length(position);
}

#part splat
void split_hide(inout Splat splat) {
  splat.is_hidden = splat.is_hidden || eye_distance(splat.position) < instance.split_distance;
}

#part corner
void split_tell(int corner, float slot, vec3 eye) {
  split_place = eye;
}

#part visibility.frag, of_polygons
void split_keep() {
  if (instance.split_distance > 0.0 && eye_distance(split_place) > instance.split_distance) discard;
}

#part polygons.frag
void split_keep() {
  if (instance.split_distance > 0.0 && eye_distance(split_place) > instance.split_distance) discard;
}
