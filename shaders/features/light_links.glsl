// References: Blender manual, "Light Linking".
// Summary: lights that affect only some objects: a sample belongs to each set of objects by a share.

#part gbuffer
void light_links_add(inout Fragment f) {
  gbuffer_light_set = instance.light_set * f.weight;
}

#part lights
vec4 light_set;  // of the sample being shaded: its share of each set of objects

void light_links_receive(inout LightTexels of) {
  of.strength.rgb *= dot(texelFetch(lights, ivec2(5, of.number), 0), light_set);
}

#part shaded_sample
void light_links_prepare(inout Shaded s) {
  light_set = texelFetch(gbuffer_light_set, s.texel, 0);
  light_set /= max(dot(light_set, vec4(1.0)), 1e-30);
}

#part shaded_sample, polygons
void light_links_polygons_prepare(inout Shaded s) {
  int set = int(texelFetch(polygon_material, s.texel, 0).w);
  light_set = mix(light_set, vec4(equal(ivec4(0, 1, 2, 3), ivec4(set))), s.mean.polygon);
}

#part lit_splats.frag
void light_links_prepare(Splat splat, int index) {
  light_set = instance.light_set;
}
