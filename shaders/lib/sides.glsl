// References: this project; docs/evidence/rendering.md shows pictures with and without.
// Summary: which side of a splat the viewer sees. A splat's back counts for little where the front of another lies
//          in its place: behind a silhouette splats stick out by their radius, and would rim it with the light of
//          the far side. Alone, a back is drawn as any splat. The twin of reference/splats.py.

#include "lib/sides/{sides}.glsl"

// A splat that shows less of itself is not there at all, and holds no layer.
const float LEAST_OPACITY = 1e-3;

// Cosine between the splat's outward side and the direction to the viewer; orientation is -1 in a mirrored object.
float outward_cosine(vec3 position, vec3 axis_u, vec3 axis_v, float orientation, bool is_orthographic) {
  vec3 outward = cross(axis_u, axis_v) * orientation;
  vec3 to_eye = is_orthographic ? vec3(0.0, 0.0, 1.0) : -position;
  return dot(outward, to_eye) / max(length(outward) * length(to_eye), 1e-37);
}
