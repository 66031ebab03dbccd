// References: "View-independent object-space surface splatting", section 4.4 (texture-mapped splats, looked up with the
//             pixel's anisotropic footprint); Heckbert, "Fundamentals of Texture Mapping", 1989 (elliptical weighted
//             averages of texels); McCormack et al., "Feline", 1999 (probes along a footprint).
// Summary: a texture's colour under a footprint given by its variances. If the footprint is wider than a texel, this is
//          the average of the texels in an ellipse, on the level where it is about a texel wide across; for
//          magnification, bilinear probes. It uses no sampler state and no hardware derivatives, so all devices agree.
//          The twin of reference/texture_lookup.py. Layout of atlas and table: rendering/upload/atlas.py.

const float MAGNIFIED = 0.2;     // variance across, in texels, below which bilinear lookups are needed
const float NARROWEST = 0.6;     // variance across, in texels of the level, of the texels' weights
const float LONGEST = 64.0;      // variance along over variance across that is kept; what is longer is blurred across
const float LARGEST = 16.0;      // variance, in texels of the coarsest level, that bounds the loops: the mean is left
const float REACH2 = 8.0;        // square of the deviations after which weights (1 - rho^2)^2 end: that is their variance
const int MAX_PROBES = 24;       // of a magnified texture, along
const float PROBES_PER_DEVIATION = 3.0;
const float AXIS_BIAS = 1e-3;

const int REPEAT = 0, EXTEND = 1, CLIP = 2, MIRROR = 3;
const int CUT_OUT = 4;           // added to them

struct SurfaceTexture {
  int slot;
  int levels;     // 0 where the surfels' own colours are meant
  vec3 factor;
  int extension;
  bool is_cut_out;
  bool is_closest;
  vec2 size;
};

SurfaceTexture surface_texture(int slot) {
  vec4 first = texelFetch(texture_table, ivec2(0, slot), 0), second = texelFetch(texture_table, ivec2(1, slot), 0);
  int kind = int(second.x);
  return SurfaceTexture(slot, int(first.w), first.rgb, kind % CUT_OUT, kind >= CUT_OUT, second.y > 0.5, second.zw);
}

// Index of a texel inside the image for a texel's integer coordinate; -1: transparent black.
float wrapped(float index, float size, int extension) {
  if (extension == REPEAT) return index - size * floor((index + 0.5) / size);
  if (extension == MIRROR) {
    float turned = index - 2.0 * size * floor((index + 0.5) / (2.0 * size));
    return min(turned, 2.0 * size - 1.0 - turned);
  }
  if (extension == CLIP && (index < 0.0 || index >= size)) return -1.0;
  return clamp(index, 0.0, size - 1.0);
}

vec4 texel(vec4 place, float x, float y) {
  return min(x, y) < 0.0 ? vec4(0.0) : texelFetch(texture_atlas, ivec2(place.xy) + ivec2(x, y), 0);
}

// The texture coordinate reduced to one period, so that texel numbers are small; beyond 4 everything is border.
vec2 reduced(vec2 uv, int extension) {
  if (extension == REPEAT) return uv - floor(uv);
  if (extension == MIRROR) return uv - 2.0 * floor(0.5 * uv);
  return clamp(uv, -4.0, 4.0);
}

// Premultiplied colour of the image itself at a point.
vec4 point_color(SurfaceTexture t, vec4 place, vec2 uv) {
  vec2 position = reduced(uv, t.extension) * place.zw - (t.is_closest ? 0.0 : 0.5);
  vec2 low = floor(position), share = position - low;
  float x = wrapped(low.x, place.z, t.extension), y = wrapped(low.y, place.w, t.extension);
  if (t.is_closest) return texel(place, x, y);
  float right = wrapped(low.x + 1.0, place.z, t.extension), above = wrapped(low.y + 1.0, place.w, t.extension);
  vec4 bottom = mix(texel(place, x, y), texel(place, right, y), share.x);
  return mix(bottom, mix(texel(place, x, above), texel(place, right, above), share.x), share.y);
}

// Half the length over which probes are spread; the variance of Gaussian weights at the middles of 2, 3 and more parts
// of -1 .. 1 is known.
float probe_reach(float spread, int probes) {
  return probes == 1 ? 0.0 : spread * inversesqrt(probes == 2 ? 0.25 : probes == 3 ? 0.2005 : 0.1945);
}

// Premultiplied sum over probes, with the sum of their weights in `weights`. spread: deviations along the axis and
// across.
vec4 probe_sum(SurfaceTexture t, vec4 place, vec2 uv, vec2 spread, vec2 axis, out float weights) {
  ivec2 probes = min(ivec2(1.5 + PROBES_PER_DEVIATION * spread), MAX_PROBES);
  vec2 along = axis * probe_reach(spread.x, probes.x) / t.size;
  vec2 across = vec2(-axis.y, axis.x) * probe_reach(spread.y, probes.y) / t.size;
  vec4 total = vec4(0.0);
  weights = 0.0;
  for (int j = 0; j < probes.y; j++) {
    for (int i = 0; i < probes.x; i++) {
      vec2 at = (2.0 * vec2(i, j) + 1.0) / vec2(probes) - 1.0;
      float weight = exp(-2.0 * dot(at, at));
      total += weight * point_color(t, place, uv + along * at.x + across * at.y);
      weights += weight;
    }
  }
  return total;
}

// As above, over the texels in an ellipse. variances: xx, yy, xy in texels of the level.
vec4 ellipse_sum(SurfaceTexture t, vec4 place, vec2 uv, vec3 variances, out float weights) {
  vec2 middle = reduced(uv, t.extension) * place.zw - 0.5;
  vec3 conic = vec3(variances.y, variances.x, -variances.z)
      / (REACH2 * (variances.x * variances.y - variances.z * variances.z));
  float height = sqrt(REACH2 * variances.y);
  vec4 total = vec4(0.0);
  weights = 0.0;
  for (float y = ceil(middle.y - height); y <= middle.y + height; y += 1.0) {
    float dy = y - middle.y;
    float row = conic.z * dy / conic.x, left = 1.0 - dy * dy / (REACH2 * variances.y);
    float width = sqrt(max(left / conic.x, 0.0));
    float row_y = wrapped(y, place.w, t.extension);
    for (float x = ceil(middle.x - row - width); x <= middle.x - row + width; x += 1.0) {
      float dx = x - middle.x + row;
      float weight = max(left - conic.x * dx * dx, 0.0);
      weight *= weight;
      total += weight * texel(place, wrapped(x, place.z, t.extension), row_y);
      weights += weight;
    }
  }
  return total;
}

// Premultiplied sum under the Gaussian at uv whose variances and covariance xx, yy, xy are given, with the sum of the
// weights.
vec4 texture_sum(SurfaceTexture t, vec2 uv, vec3 variances, out float weights) {
  float xx = variances.x * t.size.x * t.size.x, yy = variances.y * t.size.y * t.size.y;
  float xy = variances.z * t.size.x * t.size.y;
  float tilt = 0.5 * (xx - yy), root = sqrt(tilt * tilt + xy * xy);
  float along = 0.5 * (xx + yy) + root;
  float largest = LARGEST * exp2(2.0 * float(t.levels - 1));
  if (isnan(along) || along >= largest) {  // some drivers take NaN for smaller in !(along < largest)
    xx = yy = along = largest;
    xy = tilt = root = 0.0;
  }
  // A round footprint has no long axis: a bias chooses one independent of rounding.
  float biased = tilt + AXIS_BIAS * (xx + yy), biased_root = sqrt(biased * biased + xy * xy);
  vec2 axis = biased >= 0.0 ? vec2(biased + biased_root, xy) : vec2(xy, biased_root - biased);
  axis *= inversesqrt(max(dot(axis, axis), 1e-30));
  float across = max((xx * yy - xy * xy) / max(along, 1e-30), 0.0), blur = max(along / LONGEST - across, 0.0);

  if (across + blur < MAGNIFIED) {
    vec4 place = texelFetch(texture_table, ivec2(2, t.slot), 0);
    return probe_sum(t, place, uv, sqrt(vec2(along, across)), axis, weights);
  }
  // Texels of level l are averages with a variance of (4^l - 1) / 12; interpolation between texels of the image adds
  // 1 / 6.
  int level = min(int(0.5 * log2(max((across + blur + 0.25) / (NARROWEST + 1.0 / 12.0), 1.0))), t.levels - 1);
  float texel2 = exp2(2.0 * float(level)), own = 0.25 - texel2 / 12.0;
  vec2 blurred = axis.yx * axis.yx * blur + own;
  vec3 weighed = vec3(xx + blurred.x, yy + blurred.y, xy - axis.x * axis.y * blur) / texel2;
  return ellipse_sum(t, texelFetch(texture_table, ivec2(2 + level, t.slot), 0), uv, weighed, weights);
}

// Colour, not premultiplied.
vec3 texture_color(SurfaceTexture t, vec2 uv, vec3 variances) {
  float weights;
  vec4 total = texture_sum(t, uv, variances, weights);
  return t.factor * total.rgb / (total.a > 0.0 ? total.a : weights);
}

float texture_alpha(SurfaceTexture t, vec2 uv, vec3 variances) {
  float weights;
  return texture_sum(t, uv, variances, weights).a / weights;
}
