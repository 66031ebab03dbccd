// References: rendering/storages.py, which registers the ways to store splats.
// Summary: a splat as it is stored, in its object's space; the file of the storage in use finds it in its textures.

const int SPLATS_PER_ROW = 512;
const int TEXELS_PER_SPLAT = 4;

struct StoredSplat {
  vec3 position;
  vec3 axis_u;  // half-axes
  vec3 axis_v;
  vec3 normal;  // for shading
  float material;  // index
  vec4 color;
};

#include "storage/{storage}.glsl"

vec2 quad_corner(int vertex) {
  return vec2((vertex & 1) == 1 ? 1.0 : -1.0, (vertex & 2) == 2 ? 1.0 : -1.0);
}
