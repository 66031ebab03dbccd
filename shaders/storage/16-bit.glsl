// References: rendering/upload/packing_16_bit.py, which writes this layout and says what each number may lose;
//             Terzakis, Lourakis, Ait-Boudaoud, "Modified Rodrigues Parameters", J. Math. Imaging Vis. 2018 (rotation).
// Summary: four texels of 16-bit numbers per splat, 512 splats per row; each row is a block with its own box, longest
//          half-axis and brightest colour, in float32.

#include "lib/octahedron.glsl"

// 0 to 1 mapped to -1 to 1, with an exact 0.
vec4 signed_16_bit(vec4 stored) {
  return (stored * 65535.0 - 32767.0) / 32767.0;
}

StoredSplat stored_splat(int index) {
  int row = index / SPLATS_PER_ROW;
  ivec2 texel = ivec2((index % SPLATS_PER_ROW) * TEXELS_PER_SPLAT, row);
  vec4 block_low = texelFetch(surfel_blocks, ivec2(0, row), 0);   // corner of the box, longest half-axis
  vec4 block_size = texelFetch(surfel_blocks, ivec2(1, row), 0);  // of the box, log2 of longest over shortest half-axis
  float brightest = texelFetch(surfel_blocks, ivec2(2, row), 0).x;
  vec4 place = texelFetch(surfels, texel, 0);
  vec4 turn = signed_16_bit(texelFetch(surfels, texel + ivec2(1, 0), 0));
  vec4 shape = texelFetch(surfels, texel + ivec2(2, 0), 0);
  vec4 tint = texelFetch(surfels, texel + ivec2(3, 0), 0);

  // The rotation's parameters p are (x, y, z) / (1 + w) of its quaternion.
  float p2 = dot(turn.xyz, turn.xyz);
  vec4 q = vec4(2.0 * turn.xyz, 1.0 - p2) / (1.0 + p2);
  vec3 u = vec3(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
  vec3 v = vec3(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
  vec2 lengths = block_low.w * exp2(-block_size.w * shape.xy);
  vec3 root = signed_16_bit(tint).rgb;
  vec3 normal = octahedral_decode(vec2(signed_16_bit(place).w, turn.w));
  return StoredSplat(block_low.xyz + block_size.xyz * place.xyz, u * lengths.x, v * lengths.y, normal,
                     floor(shape.z * 65535.0 + 0.5), vec4(root * root * root * brightest, tint.a));
}

#part hidden_backs
bool take_hidden_back(inout StoredSplat stored, int index) {
  ivec2 texel = ivec2((index % SPLATS_PER_ROW) * TEXELS_PER_SPLAT + 2, index / SPLATS_PER_ROW);
  return texelFetch(surfels, texel, 0).w * 65535.0 > float(BLEND_STEPS) - 0.5;
}

#part blend_depth
// The share of the radius over which a splat blends; a whole 1 is added where the back is hidden.
float take_blend_depth(inout StoredSplat stored, int index) {
  ivec2 texel = ivec2((index % SPLATS_PER_ROW) * TEXELS_PER_SPLAT + 2, index / SPLATS_PER_ROW);
  float left_out = floor(texelFetch(surfels, texel, 0).w * 65535.0 + 0.5) / float(BLEND_STEPS);
  return 1.0 - fract(left_out);
}
