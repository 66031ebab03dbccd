// References: as environment_image.glsl.
// Summary: the background where nothing is drawn: the world image.

#include "lib/environment_image.glsl"

// Premultiplied, for the sample at that texel.
vec4 world_background(ivec2 texel) {
  vec2 place = view.window.xy + (vec2(texel) + 0.5) * view.window.zw;
  vec3 direction = view.is_parallel > 0.5 ? vec3(0.0, 0.0, -1.0) : vec3(place, -1.0);
  vec3 seen = environment_image_at(mat3(frame.to_environment) * normalize(direction));
  return vec4(seen * frame.background.rgb, 1.0) * frame.background.w;
}
