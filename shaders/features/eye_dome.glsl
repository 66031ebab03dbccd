// References: Boucheny, "Visualisation scientifique de grands volumes de donnees", thesis, Grenoble, 2009 (shading by
//             depth alone: how much of the dome around the view neighbours hide);
//             Schuetz, "Potree: Rendering Large Point Clouds in Web Browsers", thesis, Vienna, 2016 (a ring of eight).
// Summary: darkens a sample by how steeply the eight around it rise towards the viewer above the plane through it. The
//          plane's slope along an axis is the smaller one of those to both sides, so that a plane, however oblique,
//          stays as it is. The twin of reference/eye_dome.py.

#part shaded_sample
// The tangents of the angles by which the samples on both sides of one rise, added up. Empty ones have depth 0 and hide
// nothing; what is opposite them may be the plane's own slope.
float rise_beside(ivec2 texel, ivec2 along, float depth) {
  ivec2 size = textureSize(sample_depths, 0), ahead = texel + along, back = texel - along;
  if (any(lessThan(min(ahead, back), ivec2(0))) || any(greaterThanEqual(max(ahead, back), size))) return 0.0;
  vec2 both = vec2(texelFetch(sample_depths, ahead, 0).r, texelFetch(sample_depths, back, 0).r);
  if (!(both.x > 0.0 && both.y > 0.0)) return 0.0;
  // Along a plane, depths of a parallel view change evenly, and reciprocals of depth in perspective.
  vec2 nearer = view.is_parallel > 0.5 ? depth - both : depth / both - 1.0;
  vec2 rise = max(nearer - max(-nearer.yx, 0.0), 0.0);
  return (rise.x + rise.y) / length(vec2(along) * view.window.zw);
}

void eye_dome_finish(inout Shaded s) {
  int straight = int(frame.eye_dome_steps.x), slanted = int(frame.eye_dome_steps.y);
  ivec2 ways[4] = ivec2[4](ivec2(straight, 0), ivec2(0, straight), ivec2(slanted, slanted), ivec2(slanted, -slanted));
  float sum = 0.0;
  for (int i = 0; i < 4; i++) sum += rise_beside(s.texel, ways[i], s.mean.depth);
  s.color *= exp(-frame.eye_dome_gain * sum / 8.0);
}
