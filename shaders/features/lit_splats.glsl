// References: Botsch, Kobbelt 2003, section 4 (lighting and colour are combined for each splat); Guennebaud et al. 2006,
//             section 5.1 (they are blended with shaded polygons).
// Summary: uses the lit colour of each splat as its colour.

#part splat_varyings
void lit_splats_tell(Splat splat, int index) {
  int place = gl_VertexID / 3;  // among those that are drawn
  color_weight.rgb = texelFetch(lit_splats, ivec2(place % SPLATS_PER_ROW, place / SPLATS_PER_ROW), 0).rgb;
}

#part shaded_sample, polygons
// The sample was lit as the polygon is.
void lit_splats_finish(inout Shaded s) {
  s.color = splats_share < 1.0 ? mix(s.color, splats_color, splats_share) : splats_color;
  float size = length(blended_normal);
  if (size > CANCELLED) s.normal = blended_normal / size;
}
