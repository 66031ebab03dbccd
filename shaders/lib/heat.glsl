// References: none needed.
// Summary: maps a number to a colour: blue, cyan, green, yellow and red in even steps from 0 to 1.

vec3 heat(float t) {
  float at = 4.0 * clamp(t, 0.0, 1.0);
  return clamp(vec3(at - 2.0, 2.0 - abs(at - 2.0), 2.0 - at), 0.0, 1.0);
}
