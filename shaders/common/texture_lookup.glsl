// References: "View-independent object-space surface splatting", section 4.4 (texture-mapped splats, looked up with the
//             pixel's anisotropic footprint); McCormack et al., "Feline", 1999 (probes along the footprint's long
//             axis); Heckbert, "Fundamentals of Texture Mapping", 1989 (Gaussian footprints).
// Summary: a texture's colour under a footprint. Footprints are Gaussians, added up by their variances: a bilinear lookup
//          of the level that is at most half as wide as the footprint across, and a grid of probes that spread it.
//          No sampler state and no derivative of the hardware: the same on every device.
//          The twin of rendering/texture_lookup.py. The layout of atlas and table is rendering/atlas.py's.
//
// The includer declares the samplers `texture_atlas` and `texture_table`.

const int MAX_PROBES = 24;              // along
const float PROBES_PER_DEVIATION = 3.0;  // of the level's texels: bilinear kernels this far apart still look like one
const float LEVEL_SHARE = 0.25;         // of the footprint's variance across that the level's own kernel may have
const float LONGEST = 32.0;             // variance along, of one across of 1/2, that probes can spread
const float AXIS_BIAS = 1e-3;
const float LARGEST = 1e12;             // variance beyond which only the mean of the texture is left

const int REPEAT = 0, EXTEND = 1, CLIP = 2, MIRROR = 3;

struct SurfaceTexture {
  int slot;
  int levels;     // 0 where the surfels' own colours are meant
  vec3 factor;
  int extension;
  bool is_closest;
  vec2 size;
};

SurfaceTexture surface_texture(int slot) {
  vec4 first = texelFetch(texture_table, ivec2(0, slot), 0), second = texelFetch(texture_table, ivec2(1, slot), 0);
  return SurfaceTexture(slot, int(first.w), first.rgb, int(second.x), second.y > 0.5, second.zw);
}

// Texel index in 0 .. size - 1 of one that a lookup at a reduced coordinate may ask for; -1: transparent black.
int wrapped(int index, int size, int extension) {
  if (extension == REPEAT) return index < 0 ? index + size : index >= size ? index - size : index;
  if (extension == MIRROR) {
    int turned = index < 0 ? index + 2 * size : index >= 2 * size ? index - 2 * size : index;
    return min(turned, 2 * size - 1 - turned);
  }
  if (extension == CLIP && (index < 0 || index >= size)) return -1;
  return clamp(index, 0, size - 1);
}

vec4 texel(ivec4 place, int extension, ivec2 index) {
  ivec2 inside = ivec2(wrapped(index.x, place.z, extension), wrapped(index.y, place.w, extension));
  return min(inside.x, inside.y) < 0 ? vec4(0.0) : texelFetch(texture_atlas, place.xy + inside, 0);
}

// The texture coordinate as one period of it, so that texel indices stay small; beyond 4 all is border.
vec2 reduced(vec2 uv, int extension) {
  if (extension == REPEAT) return uv - floor(uv);
  if (extension == MIRROR) return uv - 2.0 * floor(0.5 * uv);
  return clamp(uv, -4.0, 4.0);
}

// Premultiplied colour of one level.
vec4 level_color(SurfaceTexture t, ivec4 place, vec2 uv, bool is_closest) {
  vec2 position = reduced(uv, t.extension) * vec2(place.zw);
  if (is_closest) return texel(place, t.extension, ivec2(floor(position)));
  vec2 low = floor(position - 0.5), share = position - 0.5 - low;
  ivec2 index = ivec2(low);
  vec4 bottom = mix(texel(place, t.extension, index), texel(place, t.extension, index + ivec2(1, 0)), share.x);
  vec4 top = mix(texel(place, t.extension, index + ivec2(0, 1)), texel(place, t.extension, index + ivec2(1, 1)), share.x);
  return mix(bottom, top, share.y);
}

ivec4 level_place(SurfaceTexture t, int level) {
  return ivec4(texelFetch(texture_table, ivec2(2 + level, t.slot), 0));
}

// Half of the length over which probes spread; of Gaussian weights at the middles of 2, 3 and more parts of -1 .. 1 the
// variance is known.
float probe_reach(float spread, int probes) {
  return probes == 1 ? 0.0 : spread * inversesqrt(probes == 2 ? 0.25 : probes == 3 ? 0.2005 : 0.1945);
}

// Colour, not premultiplied, under the Gaussian at uv whose variances and covariance xx, yy, xy are given.
vec3 texture_color(SurfaceTexture t, vec2 uv, vec3 variances) {
  float xx = variances.x * t.size.x * t.size.x, yy = variances.y * t.size.y * t.size.y;
  float xy = variances.z * t.size.x * t.size.y;
  float tilt = 0.5 * (xx - yy), root = sqrt(tilt * tilt + xy * xy);
  float along = 0.5 * (xx + yy) + root;
  bool is_usable = along < LARGEST;   // not so for NaN
  // A round footprint has no long axis: the bias gives it one that rounding does not turn.
  float biased = tilt + AXIS_BIAS * (xx + yy), biased_root = sqrt(biased * biased + xy * xy);
  vec2 axis = biased >= 0.0 ? vec2(biased + biased_root, xy) : vec2(xy, biased_root - biased);
  if (!is_usable) axis = vec2(1.0, 0.0);
  along = is_usable ? along : LARGEST;
  float across = is_usable ? (xx * yy - xy * xy) / max(along, 1e-30) : LARGEST;
  across = max(max(across, 0.0), (along - LONGEST) / (2.0 * LONGEST));

  // A bilinear lookup of level l is wider than one of the image itself, whose kernel is part of the texture, by the
  // variance (4^l - 1) / 4; probes spread what is left.
  int level = min(int(0.5 * log2(1.0 + 4.0 * LEVEL_SHARE * across)), t.levels - 1);
  ivec4 place = level_place(t, level);
  float texel2 = exp2(2.0 * float(level)), kernel = 0.25 * (texel2 - 1.0);
  vec2 spread = sqrt(max(vec2(along, across) - kernel, 0.0));
  ivec2 probes = min(ivec2(1.5 + PROBES_PER_DEVIATION * spread * inversesqrt(texel2)), MAX_PROBES);
  axis *= inversesqrt(max(dot(axis, axis), 1e-30));
  vec2 reach_along = axis * probe_reach(spread.x, probes.x) / t.size;
  vec2 reach_across = vec2(-axis.y, axis.x) * probe_reach(spread.y, probes.y) / t.size;
  bool is_closest = t.is_closest && level == 0;
  vec4 total = vec4(0.0);
  float weights = 0.0;
  for (int j = 0; j < probes.y; j++) {
    for (int i = 0; i < probes.x; i++) {
      vec2 at = (2.0 * vec2(i, j) + 1.0) / vec2(probes) - 1.0;
      float weight = exp(-2.0 * dot(at, at));
      total += weight * level_color(t, place, uv + reach_along * at.x + reach_across * at.y, is_closest);
      weights += weight;
    }
  }
  return t.factor * total.rgb / (total.a > 0.0 ? total.a : weights);
}
