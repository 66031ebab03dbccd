// References: none needed.
// Summary: outputs the mean normal of a pixel's samples, and their coverage.

#part pixel
void normal_coverage_pixel(vec4 normal) {
  normal_coverage = normal;
}

#part layer_pixel
void normal_coverage_pixel(vec3 normal) {
  layers_normal = vec4(normal, 0.0);
}

#part before_layers, layers_normal
void normal_coverage_before(ivec2 pixel, inout vec4 normal) {
  normal.xyz += texelFetch(layers_normal, pixel, 0).xyz;
}

#part background.frag
void normal_coverage_pixel() {
  normal_coverage = vec4(0.0);
}
