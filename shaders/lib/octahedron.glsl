// References: Meyer, Suessmuth, Sussner, Stamminger, Greiner, "On Floating-Point Normal Vectors", EGSR 2010;
//             Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 2014.
// Summary: a unit vector in two numbers; the twin of rendering/upload/packing.py's octahedral.

vec3 octahedral_decode(vec2 e) {
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  float fold = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -fold : fold;
  n.y += n.y >= 0.0 ? -fold : fold;
  return normalize(n);
}
