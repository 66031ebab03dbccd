// References: rendering/scene/finish.py, whose numbers these are.
// Summary: the finish of the sample being shaded: the frame's finishes, mixed by its shares.

vec4 finish_shares = vec4(0.0);  // of all but the first

// Four of its numbers.
vec4 finish_numbers(int column) {
  vec4 first = frame.finish_0[column];
  return first + (frame.finish_1[column] - first) * finish_shares.x + (frame.finish_2[column] - first) * finish_shares.y
      + (frame.finish_3[column] - first) * finish_shares.z + (frame.finish_4[column] - first) * finish_shares.w;
}
