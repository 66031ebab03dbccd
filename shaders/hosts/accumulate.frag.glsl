// References: Haeberli & Akeley 1990, "The accumulation buffer".
// Summary: adds a sample's picture, without the margin of its tile, to the previous ones.

void main() {
  sample_sum = texelFetch(combined, ivec2(gl_FragCoord.xy) - ivec2(frame.corner.xy), 0);
}
