// References: none needed.
// Summary: how much the texture coordinates of a polygon change from sample to sample.

const float LEAST_PLANE_FACING = 1e-4;

// Per sample along x and y. along_u, along_v: change along the axes of view space. point: of the ray, on the plane at
// depth 1.
mat2 uv_change(vec3 along_u, vec3 along_v, vec2 point, float depth) {
  bool is_orthographic = view.is_parallel > 0.5;
  vec3 ray = is_orthographic ? vec3(0.0, 0.0, -1.0) : vec3(point, -1.0);
  float facing = dot(triangle_plane, ray);
  facing = abs(facing) > LEAST_PLANE_FACING ? facing : (facing < 0.0 ? -LEAST_PLANE_FACING : LEAST_PLANE_FACING);
  float unit = is_orthographic ? 1.0 : depth;
  vec3 along_x = vec3(1.0, 0.0, 0.0) - ray * (triangle_plane.x / facing);
  vec3 along_y = vec3(0.0, 1.0, 0.0) - ray * (triangle_plane.y / facing);
  return mat2(dot(along_u, along_x), dot(along_v, along_x), dot(along_u, along_y), dot(along_v, along_y))
      * unit * mat2(view.window.z, 0.0, 0.0, view.window.w);
}

// Variances and covariance of the coordinates under a filter of this variance in samples.
vec3 uv_variances(float variance, mat2 change) {
  mat2 spread = variance * change * transpose(change);
  return vec3(spread[0].x, spread[1].y, spread[0].y);
}
