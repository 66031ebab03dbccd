// References: Zeltner, Burley, Chiang, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines", 2022; the
//             rational fits to its tables that MaterialX 1.39 publishes.
// Summary: a layer of fibres, by the cosine to the viewer and a roughness from 0.01 to 1. The twin of reference/sheen.py.

// Albedo under a uniform world: a Gaussian over the cosine, and an offset.
float sheen_albedo(float cosine, float roughness) {
  float y = roughness;
  float width = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y));
  float middle = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
  float offset = y * (0.000654023 + y * (-0.0207818 + 0.119681 * y)) / (1.26264 + y * (-1.92021 + y));
  float away = (cosine - middle) / width;
  return clamp(exp(-0.5 * away * away) / (width * 2.50662827) + offset, 0.0, 1.0);
}

// a and b of the transform (a x + b z, a y, z) from directions of the lobe, in the frame whose x is the view's direction
// along the surface and z the normal, to a clamped cosine.
vec2 sheen_transform(float cosine, float roughness) {
  float x = cosine, y = roughness;
  float a = (2.58126 * x + 0.813703 * y) * y / (1.0 + 0.310327 * x * x + 2.60994 * x * y);
  float b = sqrt(max(1.0 - x, 0.0)) * (y - 1.0) * y * y * y / (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y);
  return vec2(a, b);
}
