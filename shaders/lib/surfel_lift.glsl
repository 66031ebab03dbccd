// References: sampling/attributes/lifts.py, which finds lifts; rendering/upload/packing.py, which writes this layout.
// Summary: how high the smooth surface that shading normals describe lies above a splat, in view space; backs see no
//          such surface above them.

float surfel_lift(Splat splat, int index) {
  ivec2 texel = ivec2((index % SPLATS_PER_ROW) / 4, index / SPLATS_PER_ROW);
  if (splat.is_back || texel.y >= textureSize(surfel_lifts, 0).y) return 0.0;
  float radius = sqrt(max(dot(splat.axis_u, splat.axis_u), dot(splat.axis_v, splat.axis_v)));
  return radius * texelFetch(surfel_lifts, texel, 0)[index & 3];
}
