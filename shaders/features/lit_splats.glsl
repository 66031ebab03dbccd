// References: Botsch, Kobbelt 2003, section 4 (lighting and colour are combined for each splat).
// Summary: uses the lit colour of each splat as its colour.

#part splat_varyings
void lit_splats_tell(Splat splat, int index) {
  color_weight.rgb = texelFetch(lit_splats, ivec2(index % SPLATS_PER_ROW, index / SPLATS_PER_ROW), 0).rgb;
}
