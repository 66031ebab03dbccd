// References: Wyman, McGuire, "Hashed Alpha Testing", 2017 (alpha as the probability of being kept, so that leaves keep
//             their area at any distance); lib/own_threshold.glsl.
// Summary: polygons with holes where their texture is transparent. A sample is kept if the alpha under it exceeds a
//          threshold that differs from triangle to triangle, from sample to sample, and from frame to frame of those
//          that are averaged.

#part corner
#include "lib/own_threshold.glsl"
void cut_outs_tell(int corner, float slot, vec3 eye) {
  cut_surface = surface_number(corner / 3, int(instance.normal_matrix[3].x));
}

#part polygon_visibility.vert
#include "lib/uv_gradient.glsl"

// Visibility moves corners away from the eye, by shares that differ: coordinates are interpolated as if it did not.
void cut_outs_moved(int corner, float slot, vec3 eye, vec3 first, vec3 outward, vec4 moved) {
  float stretch = view.is_parallel > 0.5 || eye.z == 0.0 ? 1.0 : moved.w / -eye.z;
  texture_slot = texture_slot_of(slot);
  triangle_plane = outward / max(length(outward), 1e-30);
  uv_gradient(corner / 3 * 3, first, gradient_u, gradient_v);
  cut_place = vec3(corner_uv(corner), 1.0) * stretch;
  cut_eye = eye * stretch;
}

#part fragment
#include "lib/own_threshold.glsl"
#include "lib/texture_lookup.glsl"
#include "lib/uv_change.glsl"

const float SAMPLE_VARIANCE = 1.0 / 12.0;  // of a sample's square, in samples
const float ROUNDING_OF_ALPHA = 1e-3;      // between passes

float alpha_at(SurfaceTexture t, vec2 uv, mat2 change) {
  return texture_alpha(t, uv, uv_variances(SAMPLE_VARIANCE, change));
}

// Between 2 ROUNDING_OF_ALPHA and 1. texel: of the picture or map.
float cut_threshold(ivec2 texel, float turned) {
  return mix(2.0 * ROUNDING_OF_ALPHA, 1.0, own_threshold(cut_surface, texel, turned));
}

// The threshold of a sample of the picture.
float cut_threshold_at(ivec2 sample_at) {
  return cut_threshold(sample_at + ivec2(frame.cut_corner), frame.cut_turned);
}

#part visibility.frag
float visible_alpha(SurfaceTexture t) {
  vec3 eye = cut_eye / cut_place.z;
  return alpha_at(t, cut_place.xy / cut_place.z, uv_change(gradient_u, gradient_v, eye.xy / -eye.z, -eye.z));
}

#part visibility.frag, in_view
void cut_outs_keep() {
  if (texture_slot < 0.0) return;
  SurfaceTexture t = surface_texture(int(texture_slot));
  ivec2 sample_at = ivec2(gl_FragCoord.xy) / ivec2(1, ROWS);
  if (t.is_cut_out && !(visible_alpha(t) > cut_threshold_at(sample_at))) discard;
}

#part visibility.frag, shadow
void cut_outs_keep() {
  if (texture_slot < 0.0) return;
  SurfaceTexture t = surface_texture(int(texture_slot));
  if (t.is_cut_out && !(visible_alpha(t) > cut_threshold(ivec2(gl_FragCoord.xy), 0.0))) discard;
}

#part polygons.frag
// What visibility has found is always kept.
void cut_outs_keep() {
  if (texture_slot < 0.0) return;
  SurfaceTexture t = surface_texture(int(texture_slot));
  float least = cut_threshold_at(ivec2(gl_FragCoord.xy)) - ROUNDING_OF_ALPHA;
  if (t.is_cut_out && !(alpha_at(t, texture_uv, sample_uv_change()) > least)) discard;
}
