// References: rendering/scene/finish.py, whose numbers these are.
// Summary: the finish of the sample being shaded: the rows of the frame's table, mixed by its shares.

vec4 finish_shares = vec4(0.0);  // of all rows but the first

vec4 finish_texel(int number) {
  vec4 first = texelFetch(finishes, ivec2(number, 0), 0), mean = first;
  for (int row = 1; row < textureSize(finishes, 0).y; row++) {
    mean += (texelFetch(finishes, ivec2(number, row), 0) - first) * finish_shares[row - 1];
  }
  return mean;
}
