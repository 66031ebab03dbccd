// References: Teschner et al. 2003 (the hash).
// Summary: what cells of space know of six sides. The texture is that of rendering/bounced/table.py. The twin of
//          reference/bounced_light.py.

// What a side counts for at least, so that a surface of which no cell knows the sides that it faces has light too.
const float CELLS_LEAST = 1e-4;

vec4 cells_texel(int number) {
  return texelFetch(cells, ivec2(number % CELLS_PER_ROW, number / CELLS_PER_ROW), 0);
}

// The row of a cell in the table; -1 if it has none.
int cells_row(ivec3 cell) {
  uint hash = uint(cell.x) * 73856093u ^ uint(cell.y) * 19349663u ^ uint(cell.z) * 83492791u;
  int slots = int(frame.cells_slots), probes = int(frame.cells_probes);
  for (int k = 0; k < probes; k++) {
    vec4 slot = cells_texel(int((hash + uint(k)) & uint(slots - 1)));
    if (!(slot.w > 0.0)) break;
    if (ivec3(slot.xyz) == cell) return int(slot.w) - 1;
  }
  return -1;
}

// Whether a side of a cell shares its light with the same side of the one a step of -1, 0 or 1 away: nothing is between.
// row: -1 where the cell does not know.
bool cells_linked(int row, int side, ivec3 away) {
  if (row < 0) return true;
  int bit = (away.x + 1) * 9 + (away.y + 1) * 3 + away.z + 1;
  int first = int(frame.cells_slots) + TEXELS_PER_CELL * row;
  if (cells_texel(first + side).a < 0.0) return true;
  vec4 bits = cells_texel(first + 6 + side / 2);
  vec2 own = side % 2 == 0 ? bits.xy : bits.zw;
  return (int(bit < 13 ? own.x : own.y) >> (bit < 13 ? bit : bit - 13) & 1) != 0;
}

// What the cells around a place know of its sides, or of any sides. weight: negative where there are no cells.
vec4 cells_at(vec3 place, vec3 normal, bool any_side, out float weight) {
  vec3 at = place - 0.5, low = floor(at), share = at - low;
  ivec3 sides = ivec3(0, 2, 4) + ivec3(lessThan(normal, vec3(0.0)));
  vec3 facing = max(normal * normal, vec3(CELLS_LEAST));
  ivec3 middle = ivec3(floor(place));
  int own_row = cells_row(middle);
  vec4 total = vec4(0.0);
  float sum = 0.0;
  weight = -1.0;
  for (int k = 0; k < 8; k++) {
    ivec3 corner = ivec3(k & 1, k >> 1 & 1, k >> 2);
    vec3 near = mix(1.0 - share, share, vec3(corner));
    float own = near.x * near.y * near.z;
    if (!(own > 0.0)) continue;
    int row = cells_row(ivec3(low) + corner);
    if (row < 0) continue;
    weight = 0.0;
    int first = int(frame.cells_slots) + TEXELS_PER_CELL * row;
    for (int i = 0; i < (any_side ? 6 : 3); i++) {
      int number = any_side ? i : sides[i];
      vec4 side = cells_texel(first + number);
      if (side.a < 0.0 || !cells_linked(own_row, number, ivec3(low) + corner - middle)) continue;
      float counts = any_side ? own : own * facing[i];
      total += counts * side;
      sum += counts;
    }
  }
  weight = max(weight, sum);
  return total / max(sum, 1e-9);
}
