// References: Prony 1795 (two places and their shares follow from their first three moments).
// Summary: the two styles that a sample shows, from the means of the first three powers of their numbers, -1 to 1; and
//          what the table has of them.

struct StyleMix {
  int first;
  int second;
  float share;  // of the second
};

int style_number(float at) {
  return clamp(int(floor((at + 1.0) * 0.5 * float(STYLES - 1) + 0.5)), 0, STYLES - 1);
}

StyleMix style_mix(vec3 moments) {
  float mean = moments.x, apart = 2.0 / float(STYLES - 1);
  float variance = moments.y - mean * mean;
  if (!(variance > 1e-3 * apart * apart)) return StyleMix(style_number(mean), style_number(mean), 0.0);
  float lean = 0.5 * (moments.z - mean * (3.0 * variance + mean * mean)) / variance;
  float reach = sqrt(variance + lean * lean);
  float first = mean + lean - reach;
  return StyleMix(style_number(first), style_number(first + 2.0 * reach), (mean - first) / (2.0 * reach));
}

int main_style(vec3 moments) {
  StyleMix styles = style_mix(moments);
  return styles.share > 0.5 ? styles.second : styles.first;
}

// Colour of the lines, and their width in samples.
vec4 style_line(int number) {
  return texelFetch(style_table, ivec2(0, number), 0);
}

float style_group(int number) {
  return texelFetch(style_table, ivec2(2, number), 0).r;
}
