// References: Guennebaud, Barthe, Paulin 2006, section 6 (lighting for each splat in the last layer); McGuire, Bavoil,
//             "Weighted Blended Order-Independent Transparency", JCGT 2013.
// Summary: for everything behind the transparent layers: lit colours, and sums that determine how much the splats hide.

#part splat_varyings
void oit_tell(Splat splat, int index) {
  int place = gl_VertexID / 3;  // among those that are drawn
  vec3 lit = texelFetch(lit_splats, ivec2(place % SPLATS_PER_ROW, place / SPLATS_PER_ROW), 0).rgb;
  color_weight = vec4(lit, splat.amplitude);  // a back hides as much as a front
  opacity = splat.opacity;
}

#part gbuffer
#include "lib/rest_opacity/{rest_opacity}.glsl"

void oit_add(inout Fragment f) {
  oit_accum = vec4(f.color, 1.0) * (f.weight * opacity);
  oit_weight = vec2(rest_term(opacity), 1.0) * f.weight;
}

#part screen_space.frag
void oit_bound(inout Candidate c) {
  c.seen = vec4(texelFetch(visibility_depth, ivec2(gl_FragCoord.xy), 0).r);
  c.seen.z = c.seen.x < 1.0 ? view_depth(c.seen.x) : 3e38;
}

void oit_add(Candidate c) {
  add_to_sums(c.color, c.weight, c.depth);
}
