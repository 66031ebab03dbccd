// References: Dachsbacher, Vogelgsang, Stamminger, "Sequential Point Trees", SIGGRAPH 2003 (levels in one array, of which
//             a view draws some); rendering/upload/cuts.py, which writes the numbers.
// Summary: finds the splat of a triangle if a view draws only some of the stored splats.

#part splat
void levels_choose(inout int index) {
  index = int(texelFetch(drawn_splats, ivec2(index % NUMBERS_PER_ROW, index / NUMBERS_PER_ROW), 0).r);
}
