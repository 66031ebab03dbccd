// References: lib/style_mix.glsl.
// Summary: ramps and lines of materials.

#part splat_varyings
#include "lib/material_place.glsl"
void styles_tell(Splat splat, int index) {
  style = texelFetch(materials, material_place(index, splat.material) + ivec2(STYLE_TEXEL, 0), 0);
}

#part corner
#include "lib/material_place.glsl"
void styles_tell(int corner, float slot, vec3 eye) {
  style = texelFetch(materials, material_place(corner, slot) + ivec2(STYLE_TEXEL, 0), 0);
}

#part gbuffer
void styles_add(inout Fragment f) {
  gbuffer_style = style * f.weight;
}

#part polygons.frag
void styles_add() {
  polygon_style = style;
}

#part shaded_sample
#include "lib/style_mix.glsl"
vec3 style_moments;

void styles_prepare(inout Shaded s) {
  style_moments = s.mean.weight > 0.0 ? SUM_AT(gbuffer_style, s.texel, s.tap).xyz / s.mean.weight : vec3(0.0);
}

#part shaded_sample, polygons
void styles_polygons_prepare(inout Shaded s) {
  style_moments = mix(style_moments, SUM_AT(polygon_style, s.texel, s.tap).xyz / s.mean.sees, s.mean.polygon);
}

#part shaded_sample, ramps
#include "lib/style_ramps.glsl"
void styles_restyle(inout Shaded s, vec3 position) {
  s.color = restyled(style_moments, s.color, s.mean.color, position, s.normal);
}

#part shaded_sample, lines
void styles_finish(inout Shaded s) {
  vec4 line = style_line(main_style(style_moments));
  if (line.w > 0.0) s.color = mix(s.color, line.rgb, texelFetch(lines, s.texel, 0).r);
}

#part lit_splats.frag, ramps
#include "lib/material_place.glsl"
#include "lib/style_ramps.glsl"
void styles_restyle(inout vec3 radiance, Splat splat, int index) {
  vec3 moments = texelFetch(materials, material_place(index, splat.material) + ivec2(STYLE_TEXEL, 0), 0).xyz;
  radiance = restyled(moments, radiance, splat.color, splat.position, splat.normal);
}

#part lines.frag, polygons
void styles_polygons_blend(inout vec3 moments, MeanSurface mean, ivec2 texel) {
  moments = mix(moments, SUM_AT(polygon_style, texel, 0).xyz / mean.sees, mean.polygon);
}

#part lines.frag
#include "lib/style_mix.glsl"
int style_of(ivec2 texel) {
  MeanSurface mean = mean_surface(texel, 0);
  vec3 moments = mean.weight > 0.0 ? SUM_AT(gbuffer_style, texel, 0).xyz / mean.weight : vec3(0.0);
  #hook blend(moments, mean, texel)
  return main_style(moments);
}

void styles_widen(ivec2 texel, inout float width) {
  width = style_line(style_of(texel)).w;
}

#part lines.frag, groups
float own_group;
float met_at;  // distance in samples to another group

void styles_groups_widen(ivec2 texel, inout float width) {
  own_group = style_group(style_of(texel));
  met_at = 1e9;
}

void styles_meet(ivec2 at, float distance) {
  if (style_group(style_of(at)) != own_group) met_at = min(met_at, distance);
}

void styles_cover(vec4 own, ivec2 texel, inout float covered) {
  covered = max(covered, clamp(0.5 * style_line(style_of(texel)).w - met_at + 0.5, 0.0, 1.0));
}
