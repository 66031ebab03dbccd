// References: this project; docs/evidence/rendering.md shows pictures with and without.
// Summary: which side of a splat the viewer sees. A back gets little weight if the front of another splat is in its
//          place: behind a silhouette, splats protrude by their radius, and would give it a rim lit like the far side.
//          Alone, a back is drawn like any splat. The twin of reference/splats.py.

#include "lib/sides/{sides}.glsl"

// A splat with a smaller visible share is not drawn at all, and belongs to no layer.
const float LEAST_OPACITY = 1e-3;

// Cosine between the splat's outward side and the direction to the viewer; orientation is -1 in a mirrored object.
float outward_cosine(vec3 position, vec3 axis_u, vec3 axis_v, float orientation, bool is_orthographic) {
  vec3 outward = cross(axis_u, axis_v) * orientation;
  vec3 to_eye = is_orthographic ? vec3(0.0, 0.0, 1.0) : -position;
  return dot(outward, to_eye) / max(length(outward) * length(to_eye), 1e-37);
}
