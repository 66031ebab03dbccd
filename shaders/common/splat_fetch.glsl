// References: rendering/packing.py, which writes this layout.
// Summary: where a splat lies in the data texture: four texels each, 512 splats a row.

const int SPLATS_PER_ROW = 512;
const int TEXELS_PER_SPLAT = 4;

ivec2 splat_texel(int splat) {
  return ivec2((splat % SPLATS_PER_ROW) * TEXELS_PER_SPLAT, splat / SPLATS_PER_ROW);
}

vec2 quad_corner(int vertex) {
  return vec2((vertex & 1) == 1 ? 1.0 : -1.0, (vertex & 2) == 2 ? 1.0 : -1.0);
}
