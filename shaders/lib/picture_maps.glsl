// References: rendering/probes/flat_pictures.py, whose texture this is.
// Summary: where the maps of a picture are, and which texels surround a place in one.

// The size of a map, and the row at which it begins. size: of the whole picture.
ivec3 picture_map(ivec2 size, int number) {
  int row = number == 0 ? 0 : 2 * size.y;
  for (int k = 0; k < number; k++) {
    size = (size + 1) / 2;
    if (k + 1 < number) row += size.y;
  }
  return ivec3(size, row);
}

struct PictureTexels {
  ivec4 low_high;
  vec2 share;
};

// At a place in pixels of the whole picture.
PictureTexels picture_texels(ivec3 map, int number, vec2 place) {
  vec2 at = clamp(place / float(1 << number) - 0.5, vec2(0.0), vec2(map.xy - 1));
  ivec2 low = ivec2(floor(at)), high = min(low + 1, map.xy - 1);
  return PictureTexels(ivec4(low, high) + ivec4(0, map.z, 0, map.z), at - vec2(low));
}
