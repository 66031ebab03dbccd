// References: Diefenbach, Badler, "Multi-pass Pipeline Rendering: Realism For Dynamic Environments", I3D 1997 (the scene
//             from behind a plane); Stachowiak, "Stochastic Screen-Space Reflections", SIGGRAPH courses 2015 (a cone as
//             wide as the lobe at the distance that is hit).
// Summary: what a flat surface reflects: the picture from behind its plane, where the reflected ray meets something, as
//          blurred as the lobe is wide there, and the world beside that. The texture is that of
//          rendering/probes/mirrors.py.

#part world_light
#include "lib/picture_maps.glsl"

float mirroring = 0.0;  // 1 if this surface is the mirror's
vec3 mirroring_place;

vec4 mirror_map_at(int number, vec2 place) {
  PictureTexels at = picture_texels(picture_map(ivec2(frame.mirror_size), number), number, place);
  vec4 below = mix(texelFetch(mirror_picture, at.low_high.xy, 0), texelFetch(mirror_picture, at.low_high.zy, 0), at.share.x);
  vec4 above = mix(texelFetch(mirror_picture, at.low_high.xw, 0), texelFetch(mirror_picture, at.low_high.zw, 0), at.share.x);
  return mix(below, above, at.share.y);
}

// The mirror's picture is turned from left to right.
vec2 mirror_place_of(vec3 position) {
  vec2 seen = view.is_parallel > 0.5 ? position.xy : position.xy / -position.z;
  return vec2(frame.mirror_window.x - seen.x, seen.y - frame.mirror_window.y) * frame.mirror_window.zw;
}

// A texel that is looked up, over the lobe's half width, which is the square of the roughness.
const float MIRROR_TEXEL = 1.4;

void mirrors_reflected(inout vec3 light, vec3 direction, float roughness) {
  if (!(mirroring > 0.0)) return;
  ivec2 size = ivec2(frame.mirror_size), texel = clamp(ivec2(mirror_place_of(mirroring_place)), ivec2(0), size - 1);
  float depth = texelFetch(mirror_picture, texel + ivec2(0, size.y), 0).r * frame.mirror_scale;
  float reach = length(mirroring_place), from_eye = -mirroring_place.z;
  // how far behind the plane the image is; where nothing is met, what may be beside it is about as far as the viewer
  float away = reach;
  if (depth > 0.0) away = max(depth - from_eye, 0.0) * (view.is_parallel > 0.5 ? 1.0 : reach / from_eye);
  vec3 behind = direction - 2.0 * dot(direction, frame.mirror_normal.xyz) * frame.mirror_normal.xyz;
  vec3 image = mirroring_place + behind * away;
  vec2 place = image.z < 0.0 || view.is_parallel > 0.5 ? mirror_place_of(image) : vec2(texel) + 0.5;
  float width = roughness * roughness * away / (view.is_parallel > 0.5 ? 1.0 : reach + away);
  float number = clamp(log2(max(MIRROR_TEXEL * width * frame.mirror_window.w, 1.0)), 0.0, float(PICTURE_MAPS - 1));
  int finer = int(number);
  vec4 seen = mirror_map_at(finer, place);
  if (number > float(finer)) seen = mix(seen, mirror_map_at(finer + 1, place), number - float(finer));
  light = seen.rgb + (1.0 - seen.a) * sent_reflection(direction, roughness);
}

#part shaded_sample
// The least cosine between a surface of the mirror and its plane's normal.
const float MIRROR_FLAT = 0.7;

void mirrors_prepare(inout Shaded s) {
  mirroring_place = eye_position(s.texel, s.mean.depth);
  vec3 at = abs((frame.to_mirror * vec4(mirroring_place, 1.0)).xyz);
  bool is_in = max(max(at.x, at.y), at.z) < 1.0 && dot(s.normal, frame.mirror_normal.xyz) > MIRROR_FLAT;
  mirroring = is_in ? 1.0 : 0.0;
}
