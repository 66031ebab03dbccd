// References: none needed.
// Summary: the background where nothing is drawn: a uniform world.

// Premultiplied, for the sample at that texel.
vec4 world_background(ivec2 texel) {
  return vec4(vec3(1.0) * frame.background.rgb, 1.0) * frame.background.w;
}
