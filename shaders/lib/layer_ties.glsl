// References: docs/evidence/numerics.md.
// Summary: tolerates depths that rounding may have changed. The attribute pass must find what the visibility pass found
//          first in a layer, or the sample would be taken for a rim and get a neighbour's colour.

// The depth moved back by a few depth steps; draw.least_offset is the minimum offset of visibility.
float tied(float depth, float steps) {
  return view.is_parallel > 0.5 ? depth + steps * draw.least_offset : depth * (1.0 + steps * draw.least_offset);
}
