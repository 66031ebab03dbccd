// References: common/depth.glsl.
// Summary: between depth along the view and what the depth buffer holds. The includer says what `PROJECTION`,
//          `PARALLEL` (bool) and `DEPTH_UNIT` (1 / far) are.

float stored_depth(float depth) {
#ifdef LINEAR_DEPTH
  return depth * DEPTH_UNIT;
#else
  vec2 row = vec2(PROJECTION[2][2], PROJECTION[3][2]);
  float clip = PARALLEL ? -row.x * depth + row.y : -row.x + row.y / depth;
  return 0.5 * clip + 0.5;
#endif
}

float view_depth(float stored) {
#ifdef LINEAR_DEPTH
  return stored / DEPTH_UNIT;
#else
  vec2 row = vec2(PROJECTION[2][2], PROJECTION[3][2]);
  float clip = 2.0 * stored - 1.0;
  return PARALLEL ? (row.y - clip) / row.x : row.y / (clip + row.x);
#endif
}
