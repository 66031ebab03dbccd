// References: none needed.
// Summary: whether a transparent layer has anything in each block of the picture.

void main() {
  ivec2 size = textureSize(layer_depth, 0), block = (size + OCCUPANCY_BLOCKS - 1) / OCCUPANCY_BLOCKS;
  ivec2 first = ivec2(gl_FragCoord.xy) * block, end = min(first + block, size);
  float nearest = 1.0;
  for (int y = first.y; y < end.y; y++) {
    for (int x = first.x; x < end.x; x++) nearest = min(nearest, texelFetch(layer_depth, ivec2(x, y), 0).r);
  }
  layer_occupancy = nearest < 1.0 ? 1.0 : 0.0;
}
