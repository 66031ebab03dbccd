// References: Botsch, Spernat, Kobbelt, "Phong Splatting", 2004 (a linear field of normals for each splat);
//             splat_addon/normal_fields.py, which says what is stored.
// Summary: the shading normal changes over the splat: its direction is linear in the place within the ellipse. A pixel
//          that sees more than the splat sees its mean, nearly that at the centre. Twin: reference/rays.py.

#part splat
// Changes along the half-axes, relative to a normal of length 1 in the view. Those of a normal that points inwards turn
// with it.
void normal_fields_unpack(StoredSplat stored, int index) {
  ivec2 texel = ivec2(index % SPLATS_PER_ROW, index / SPLATS_PER_ROW);
  bool is_stored = texel.y < textureSize(normal_fields, 0).y;
  vec4 change = is_stored ? floor(texelFetch(normal_fields, texel, 0) * 65535.0 + 0.5) - 32768.0 : vec4(0.0);
  mat3 turn = mat3(instance.normal_matrix);
  vec3 along_x = turn * stored.axis_u / max(length(stored.axis_u), 1e-37);
  vec3 along_y = turn * stored.axis_v / max(length(stored.axis_v), 1e-37);
  float inward = dot(stored.normal, cross(stored.axis_u, stored.axis_v)) < 0.0 ? -1.0 : 1.0;
  float unit = NORMAL_SHARE * inward * NORMAL_STEP / max(length(turn * stored.normal), 1e-37);
  normal_u = (along_x * change.x + along_y * change.y) * unit;
  normal_v = (along_x * change.z + along_y * change.w) * unit;
}

#part splat_varyings
// Seen from behind, and along axes that merged splats have shortened.
void normal_fields_tell(Splat splat, int index) {
  float factor = splat.is_back ? -splat.shortened : splat.shortened;
  normal_u *= factor;
  normal_v *= factor;
}

#part splat_varyings, turns_sprites
#include "lib/disc_in_sprite.glsl"

// Per radius along the picture's axes, instead of per half-axis: the splat's plane is over its sprite.
void turns_sprites_tell(Splat splat, int index) {
  vec3 u = splat.axis_u / max(dot(splat.axis_u, splat.axis_u), 1e-37);
  vec3 v = splat.axis_v / max(dot(splat.axis_v, splat.axis_v), 1e-37);
  float radius = sqrt(max(dot(splat.axis_u, splat.axis_u), dot(splat.axis_v, splat.axis_v)));
  vec2 tilt = sprite_tilt(splat.axis_u, splat.axis_v);
  vec3 across = radius * vec3(1.0, 0.0, tilt.x), up = radius * vec3(0.0, 1.0, tilt.y);
  vec3 per_u = normal_u, per_v = normal_v;
  normal_u = per_u * dot(across, u) + per_v * dot(across, v);
  normal_v = per_u * dot(up, u) + per_v * dot(up, v);
}

#part object_space.vert
// Along axes that the method has widened by the pixel's filter: what it sees on average is narrower by as much as they
// are wider.
void normal_fields_axes(Splat splat, mat2 widened) {
  vec3 per_u = normal_u, per_v = normal_v;
  normal_u = (per_u * widened[0].x + per_v * widened[0].y) / dot(widened[0], widened[0]);
  normal_v = (per_u * widened[1].x + per_v * widened[1].y) / dot(widened[1], widened[1]);
}

#part screen_space.vert
// The same along axes that the method has replaced.
void normal_fields_replaced(Plane true_plane, Plane plane, bool in_space) {
  if (in_space || (true_plane.a == plane.a && true_plane.b == plane.b)) return;
  mat2 kept = transpose(mat2(true_plane.a, true_plane.b)) * transpose(inverse(mat2(plane.a, plane.b)));
  vec3 per_u = normal_u, per_v = normal_v;
  normal_u = per_u * kept[0].x + per_v * kept[0].y;
  normal_v = per_u * kept[1].x + per_v * kept[1].y;
}

#part gbuffer
vec2 normal_place;  // half-axes from the centre

// Beyond the rim, where only the filter reaches, the mean of what a pixel sees of the splat is about as far within it.
void normal_fields_weigh(inout Fragment f) {
  vec2 place = normal_place / max(dot(normal_place, normal_place), 1.0);
  f.normal = normalize(normal + normal_u * place.x + normal_v * place.y);
}

#part screen_space.frag
void normal_fields_keep(Candidate c) {
  normal_place = c.in_space ? c.place.xy : place_at(c.plane, gl_FragCoord.xy).uv;
}

#part object_space.frag
void normal_fields_keep() {
  normal_place = place_depth.xy;
}

#part point_sprite.frag
void normal_fields_keep() {
  normal_place = place;
}
