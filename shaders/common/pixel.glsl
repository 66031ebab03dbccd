// References: common/before_layers.glsl, common/outputs.glsl.
// Summary: writes a pixel of the opaque picture from the means over its samples, under what transparent layers show.

const float EMPTY_DEPTH = 1e10;
const float FARTHEST = 3.4e38;

// normal: in the camera's view, and coverage. nearest: FARTHEST where nothing was hit.
void write_pixel(vec4 color, vec4 normal, float nearest, Outputs outputs) {
  normal.xyz = mat3(shading.view_to_world) * normal.xyz;
#ifdef LAYERS
  put_layers_before(color, normal, nearest, outputs);
#endif
  combined = color;
#ifdef NORMAL_COVERAGE_OUTPUT
  normal_coverage = normal;
#endif
  write_outputs(before_background(outputs, normal.w));
  depth = nearest < FARTHEST ? nearest : EMPTY_DEPTH;
}
