// References: none needed.
// Summary: tail of the normal distribution.

// 0.5 - x (NORMAL.x + x^2 (NORMAL.y + ...)) is within 7e-4 of a normal distribution's share beyond x, to NORMAL_END.
const vec4 NORMAL = vec4(0.396668, -0.0613809, 0.00673240, -0.000320832);
const float NORMAL_END = 2.6;

// x: in standard deviations, at most NORMAL_END from the middle.
float share_beyond(float x) {
  float x2 = x * x;
  return 0.5 - x * (NORMAL.x + x2 * (NORMAL.y + x2 * (NORMAL.z + x2 * NORMAL.w)));
}
