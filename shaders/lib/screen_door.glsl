// References: Mulder, Groen, van Wijk, "Pixel Masks for Screen-Door Transparency", Visualization 1998; Bush, "Orthogonal
//             Arrays of Index Unity", 1952 (the array: 16 rows of five factors of 4 levels, of which any two are even).
// Summary: which texels of a shadow map a transparent surface fills: in each 4 x 4 block a share equal to its opacity,
//          in sixteenths. Surfaces have five masks; of two different ones, each overlaps the other in proportion.

int twice(int level) {  // in the field of four elements, where ^ adds
  return level == 0 ? 0 : (level == 3 ? 1 : level + 1);
}

int mask_level(int factor, ivec2 texel) {
  int a = texel.x & 3, b = texel.y & 3;
  if (factor == 0) return a;
  if (factor == 1) return b;
  return a ^ (factor == 2 ? b : (factor == 3 ? twice(b) : twice(twice(b))));
}

bool is_kept(float opacity, int surface, ivec2 texel) {
  int factor = surface % 5, next = (factor + 1) % 5;
  return opacity > (float(4 * mask_level(factor, texel) + mask_level(next, texel)) + 0.5) / 16.0;
}
