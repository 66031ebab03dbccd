// References: Blinn, "Models of Light Reflection for Computer Synthesized Pictures", 1977; Walter, Marschner, Li,
//             Torrance, "Microfacet Models for Refraction", 2007, section 5.2 (the exponent of a roughness).
// Summary: Blinn's lobe around the half vector. A light with a size is treated as a point at its middle.

const float MIN_ROUGHNESS = 0.03;

float blinn_exponent(float roughness) {
  float width = clamp(roughness, MIN_ROUGHNESS, 1.0);
  width *= width;
  return 2.0 / (width * width) - 2.0;
}

// cos^exponent of the angle between normal and half vector, computed from its sine, because a cosine near 1 loses
// precision.
float blinn_lobe(vec3 normal, vec3 halfway, float exponent) {
  float cosine = dot(normal, halfway);
  if (!(cosine > 0.0)) return 0.0;
  vec3 sine = cross(normal, halfway);
  return exp(-0.5 * exponent * log(1.0 + dot(sine, sine) / (cosine * cosine)));
}
