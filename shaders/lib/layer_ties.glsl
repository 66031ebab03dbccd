// References: docs/evidence/numerics.md.
// Summary: depths that rounding may have changed. What the visibility pass finds first in a layer, the attribute pass must
//          find too, or the sample would be taken for a rim and have the colour of what is beside it.

// The depth some steps of the depth's resolution farther; draw.least_offset is the least that visibility moves splats back.
float tied(float depth, float steps) {
  return view.is_parallel > 0.5 ? depth + steps * draw.least_offset : depth * (1.0 + steps * draw.least_offset);
}
