// References: "View-independent object-space surface splatting", section 4.4 (texture-mapped splats, looked up with the
//             pixel's anisotropic footprint); McCormack et al., "Feline", 1999 (probes along the footprint's long
//             axis); Heckbert, "Fundamentals of Texture Mapping", 1989 (Gaussian footprints).
// Summary: a texture's colour under a footprint. Footprints are Gaussians, added up by their variances: the level is
//          that whose bilinear lookup is as wide as the footprint is across, and the probes spread it along.
//          No sampler state and no derivative of the hardware: the same on every device.
//          The twin of rendering/texture_lookup.py. The layout of atlas and table is rendering/atlas.py's.
//
// The includer declares the samplers `texture_atlas` and `texture_table`.

const int MAX_PROBES = 16;
// Probes this many standard deviations of one texel's kernel apart still look like one Gaussian.
const float PROBES_PER_DEVIATION = 3.8;
const float LONGEST = 16.0;      // square of the deviations, in texels of the level, that MAX_PROBES can spread
const float LARGEST = 1e12;      // variance beyond which only the mean of the texture is left

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
  return ivec4(texelFetch(texture_table, ivec2(2 + min(level, t.levels - 1), t.slot), 0));
}

// Colour, not premultiplied, under the Gaussian at uv whose variances and covariance xx, yy, xy are given.
vec3 texture_color(SurfaceTexture t, vec2 uv, vec3 variances) {
  float xx = variances.x * t.size.x * t.size.x, yy = variances.y * t.size.y * t.size.y;
  float xy = variances.z * t.size.x * t.size.y;
  float tilt = 0.5 * (xx - yy), root = sqrt(tilt * tilt + xy * xy);
  float along = 0.5 * (xx + yy) + root;
  bool is_usable = along < LARGEST;   // not so for NaN
  vec2 axis = tilt >= 0.0 ? vec2(tilt + root, xy) : vec2(xy, root - tilt);
  if (!is_usable) axis = vec2(1.0, 0.0);
  along = is_usable ? along : LARGEST;
  float across = is_usable ? (xx * yy - xy * xy) / max(along, 1e-30) : LARGEST;
  across = max(max(across, 0.0), (along - LONGEST) / (1.0 + 4.0 * LONGEST));

  // A bilinear lookup of level l has the variance 4^l / 4 - 1 / 12; the image itself, level 0, has 1 / 6.
  float width2 = 1.0 + 4.0 * across;
  int level = min(int(0.5 * log2(width2)), t.levels - 1);
  float share = clamp((width2 * exp2(-2.0 * float(level)) - 1.0) / 3.0, 0.0, 1.0);
  ivec4 fine = level_place(t, level), coarse = level_place(t, level + 1);

  float spread = sqrt(max(along - across, 0.0));
  int probes = min(1 + int(PROBES_PER_DEVIATION * spread * inversesqrt(width2) + 0.3), MAX_PROBES);
  // Of Gaussian weights at the middles of 2, 3 and more parts of -1 .. 1.
  float variance = probes == 2 ? 0.25 : probes == 3 ? 0.2005 : 0.1945;
  vec2 reach = axis * (probes > 1 ? inversesqrt(max(dot(axis, axis), 1e-30) * variance) * spread : 0.0) / t.size;
  vec4 total = vec4(0.0);
  float weights = 0.0;
  for (int i = 0; i < probes; i++) {
    float place = (2.0 * float(i) + 1.0) / float(probes) - 1.0;
    float weight = exp(-2.0 * place * place);
    vec2 at = uv + reach * place;
    total += weight * mix(level_color(t, fine, at, t.is_closest && level == 0), level_color(t, coarse, at, false), share);
    weights += weight;
  }
  return t.factor * total.rgb / (total.a > 0.0 ? total.a : weights);
}
