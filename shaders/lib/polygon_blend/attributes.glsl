// References: Guennebaud et al. 2006, section 5.1 (attributes are blended before shading, which should be better).
// Summary: splats and polygon become one surface, which is lit once.

void keep_splats(MeanSurface mean) {
}

void blend_with_polygon(inout MeanSurface mean, vec3 color, vec4 normal) {
  mean.color = mix(mean.color, color, mean.polygon);
  mean.normal = mix(mean.normal, normal.xyz, mean.polygon);
}
