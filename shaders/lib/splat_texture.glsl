// References: "View-independent object-space surface splatting", section 4.4 (texture-mapped splats: every fragment looks
//             the texture up under its own footprint); Zwicker et al. 2001 (kernel and pixel filter are Gaussians).
// Summary: the colour of a texture-mapped splat at a pixel. The pixel sees kernel times pixel filter: a Gaussian
//          narrower than both, and never far outside the ellipse, under which the texture is looked up.
//          tests/rendering/test_textured.py compares it with reference/textures.py.

#part vertex
// uv, slot.
vec3 fetch_texture_place(int index, float material, out vec4 along, out vec2 border) {
  ivec2 texel = ivec2((index % SPLATS_PER_ROW) * 2, index / SPLATS_PER_ROW);
  vec4 first = texelFetch(surfel_uvs, texel, 0), second = texelFetch(surfel_uvs, texel + ivec2(1, 0), 0);
  along = vec4(first.zw, second.xy);
  border = second.zw;
  int slot = min(int(material), textureSize(texture_table, 0).y - 1);
  bool is_textured = dot(along, along) > 0.0 && texelFetch(texture_table, ivec2(0, slot), 0).w > 0.0;
  return vec3(first.xy, is_textured ? float(slot) : -1.0);
}
#part fragment
#include "lib/texture_lookup.glsl"
#include "lib/kernel_under_pixel.glsl"

// Derivative of the position in an ellipse with these half-axes in view space, per pixel along x and y, at a point of
// the picture with the given depth.
mat2 space_place_change(vec3 axis_u, vec3 axis_v, vec2 point, float depth) {
  mat2 moved = view.is_parallel > 0.5 ? mat2(axis_u.xy, axis_v.xy)
      : mat2(axis_u.xy + point * axis_u.z, axis_v.xy + point * axis_v.z) / depth;
  return inverse(moved) * mat2(view.window.z, 0.0, 0.0, view.window.w);
}

// q: the pixel's position in the ellipse; change: columns are its change per pixel along x and y.
vec3 splat_texture_color(vec3 own, vec3 place, vec4 along, vec2 border, vec2 q, mat2 change) {
  if (place.z < 0.0) return own;
  vec2 middle;
  mat2 seen;
  kernel_under_pixel(q, change, PIXEL_VARIANCE, middle, seen);
  mat2 gradient = mat2(along.xy, along.zw);
  SurfaceTexture t = surface_texture(int(place.z));
  float beyond = dot(border, middle) - 1.0;
  if (beyond > 0.0) {
    // Another chart of the map begins there, and must not be in the footprint.
    float texel = length(border * inverse(gradient) / t.size);
    float back = beyond + 2.0 * sqrt(dot(border, seen * border)) + 0.75 * texel;
    if (back < LARGEST_PIXEL) middle -= border * (back / dot(border, border));
  }
  mat2 variance = gradient * seen * transpose(gradient);
  return texture_color(t, place.xy + gradient * middle,
                       vec3(variance[0].x, variance[1].y, variance[0].y));
}
