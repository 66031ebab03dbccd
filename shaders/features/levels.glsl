// References: Dachsbacher, Vogelgsang, Stamminger, "Sequential Point Trees", SIGGRAPH 2003 (levels in one array, of which
//             a view draws some); rendering/upload/cuts.py, which writes the numbers.
// Summary: which splat a triangle draws, where a view draws some of them.

#part splat
void levels_choose(inout int index) {
  index = int(texelFetch(drawn_splats, ivec2(index % NUMBERS_PER_ROW, index / NUMBERS_PER_ROW), 0).r);
}
