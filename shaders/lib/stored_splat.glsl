// References: rendering/upload/storages.py, which registers the ways to store splats.
// Summary: a splat as stored, in its object's space; the file of the storage format reads it from its textures.

struct StoredSplat {
  vec3 position;
  vec3 axis_u;  // half-axes
  vec3 axis_v;
  vec3 normal;  // for shading
  float material;  // index
  vec4 color;
};

#include "storage/{storage}.glsl"

// Corners of the triangle around the unit circle: one triangle per splat is less work than the two of a quad, unless
// splats are many pixels wide (docs/evidence/methods.md).
vec2 triangle_corner(int vertex) {
  int corner = vertex % 3;
  return corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.73205081 : 1.73205081, -1.0);
}
