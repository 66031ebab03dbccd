// References: none needed.
// Summary: the number of splats that a sample averages: 1 blue, 4 cyan, 16 green, 64 yellow, 256 and more red.

#include "lib/heat.glsl"

float overdraw;  // of the sample being shaded

vec3 shade(vec3 position, vec3 normal, vec3 base, vec3 material) {
  return heat(log2(overdraw) / 8.0);
}
