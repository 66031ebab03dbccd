// References: Guennebaud et al. 2006, section 5 (polygons where they are large in the picture, splats elsewhere).
// Summary: of an object that is split by its distance from the camera: splats whose centres are nearer than their limit
//          are not drawn, nor polygons beyond theirs. 0 is no limit.

float split_distance(vec3 position) {
  return splats.options.z > 0.5 ? -position.z : length(position);
}
