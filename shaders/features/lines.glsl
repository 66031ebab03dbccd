// References: hosts/lines.frag.glsl.
// Summary: draws lines over the shaded picture.

#part lines.frag, depth_bounds
// The filter reaches beyond silhouettes.
void lines_see(ivec2 texel, inout bool is_seen) {
  is_seen = is_seen && texelFetch(depth_bounds, texel, 0).z < 1e38;
}

#part lines.frag, shallow_lines
const float SOFT = 0.2;  // of the least cosine, over which the line ends

// Botsch et al. 2005, section 6: outlines where the surface is seen at a shallow angle.
void lines_cover(vec4 own, ivec2 texel, inout float covered) {
  vec2 place = view.window.xy + (vec2(texel) + 0.5) * view.window.zw;
  vec3 ray = view.is_parallel > 0.5 ? vec3(0.0, 0.0, -1.0) : normalize(vec3(place, -1.0));
  covered = max(covered, clamp((1.0 - abs(dot(own.xyz, ray)) / frame.line_shallow) / SOFT, 0.0, 1.0));
}

#part shaded_sample, one_color
void lines_finish(inout Shaded s) {
  s.color = mix(s.color, frame.line_color.rgb, texelFetch(lines, s.texel, 0).r);
}
