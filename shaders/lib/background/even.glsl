// References: none needed.
// Summary: what is seen where nothing is drawn: an even world.

// Premultiplied, of the sample at that texel.
vec4 world_background(ivec2 texel) {
  return vec4(vec3(1.0) * frame.world.rgb, 1.0) * frame.world.w;
}
