// References: hosts/lines.frag.glsl.
// Summary: draws lines over the shaded picture.

#part lines.frag, depth_bounds
// The filter reaches beyond silhouettes.
void lines_see(ivec2 texel, inout bool is_seen) {
  is_seen = is_seen && texelFetch(depth_bounds, texel, 0).z < 1e38;
}

#part shaded_sample
void lines_finish(inout Shaded s) {
  s.color = mix(s.color, frame.line_color.rgb, texelFetch(lines, s.texel, 0).r);
}
