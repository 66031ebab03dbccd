// References: Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction", 2007 (GGX).
// Summary: the lobe in which rough glass spreads light.

// Share of light for a solid angle, by the square of the tangent of an angle and that of the lobe's width.
float lamp_lobe(float slope2, float width2) {
  float cosine2 = 1.0 / (1.0 + slope2), sum = slope2 + width2;
  return width2 / (3.14159265358979 * sum * sum * cosine2 * sqrt(cosine2));
}
