// References: Wyman, McGuire, "Hashed Alpha Testing", 2017 (alpha as the probability of being kept, so that leaves keep
//             their area at any distance); Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018 (the
//             thresholds); lib/screen_door.glsl in shadow maps.
// Summary: polygons with holes where their texture is transparent. A sample is kept if the alpha under it exceeds a
//          threshold that differs from sample to sample, and from frame to frame of those that are averaged.

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
#include "lib/texture_lookup.glsl"
#include "lib/uv_change.glsl"

const float SAMPLE_VARIANCE = 1.0 / 12.0;  // of a sample's square, in samples
const float ROUNDING_OF_ALPHA = 1e-3;      // between passes
const vec2 SPREAD = vec2(0.7548776662, 0.5698402910);

float alpha_at(SurfaceTexture t, vec2 uv, mat2 change) {
  return texture_alpha(t, uv, uv_variances(SAMPLE_VARIANCE, change));
}

// Between 2 ROUNDING_OF_ALPHA and 1. The cameras of frames that are averaged differ by parts of a sample, by which the
// thresholds of each sample are spread evenly. The factors are whole, so that it does not matter which corner is nearest;
// at one sample a pixel, cameras differ by multiples of SPREAD, and numbers by those of 2.62, about the golden ratio.
float cut_threshold(vec2 texel) {
  vec2 corner = view.window.xy / view.window.zw, whole = floor(corner + 0.5);
  float number = dot(whole + texel, SPREAD) + dot(corner - whole, vec2(8.0, -6.0));
  return mix(2.0 * ROUNDING_OF_ALPHA, 1.0, fract(number));
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
  vec2 texel = vec2(floor(gl_FragCoord.x), floor(gl_FragCoord.y / float(ROWS)));
  if (t.is_cut_out && !(visible_alpha(t) > cut_threshold(texel))) discard;
}

#part visibility.frag, shadow
#include "lib/screen_door.glsl"
void cut_outs_keep() {
  if (texture_slot < 0.0) return;
  SurfaceTexture t = surface_texture(int(texture_slot));
  if (t.is_cut_out && !is_kept(visible_alpha(t), int(instance.first_slot), ivec2(gl_FragCoord.xy))) discard;
}

#part polygons.frag
// What visibility has found is always kept.
void cut_outs_keep() {
  if (texture_slot < 0.0) return;
  SurfaceTexture t = surface_texture(int(texture_slot));
  float least = cut_threshold(floor(gl_FragCoord.xy)) - ROUNDING_OF_ALPHA;
  if (t.is_cut_out && !(alpha_at(t, texture_uv, sample_uv_change()) > least)) discard;
}
