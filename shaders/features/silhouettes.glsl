// References: hosts/resolve.frag.glsl.
// Summary: where the filter reaches beyond a silhouette, the surface behind it is a different one and keeps the sample.

#part screen_space.frag
// Its depth, moved back by up to 2 epsilon, is more than that and a radius behind this splat's depth. A splat that is
// this far behind the visible surface does not belong to it either, even if its plane, at grazing angles, extends in
// front of it beyond the rim.
void silhouettes_keep(inout Candidate c) {
  float apart = (1.0 + 4.0 * draw.epsilon) * c.plane.radius;
  bool is_behind = c.depth <= c.seen.z && c.plane.depth - length(c.plane.slope) - apart > c.seen.z;
  if (!c.in_space && (c.seen.w - c.compared > apart || is_behind)) discard;
}

#part screen_space.frag, opaque
const float WITHIN_RIM = 0.75;    // pixels, so that a sample there sees the splat
const float SEES_NOTHING = 1e38;  // nearer than what an empty sample sees

// How far behind the visible surface a plane is at a sample.
float behind_seen(Plane plane, ivec2 at) {
  ivec2 last = textureSize(depth_bounds, 0) - 1;
  return plane_depth(plane, place_at(plane, vec2(at) + 0.5)) - texelFetch(depth_bounds, clamp(at, ivec2(0), last), 0).z;
}

// A face seen steeply may be narrower than a pixel, so that the sample at its centre sees the face before it. It is seen
// if that face, continued as from this sample to the next outward, meets it before its centre.
bool is_seen_within_rim(Plane plane) {
  Place place = place_at(plane, gl_FragCoord.xy);
  float to_rim = inversesqrt(max(dot(place.uv, place.uv), 1.0));
  float share = max(to_rim - WITHIN_RIM * inversesqrt(max(dot(place.d, place.d), 1e-20)), 0.0);
  ivec2 at = clamp(ivec2(plane.center + place.d * share), ivec2(0), textureSize(depth_bounds, 0) - 1);
  float behind = behind_seen(plane, at);
  if (behind <= 0.0) return true;
  vec2 way = vec2(at) + 0.5 - plane.center;
  float far = length(way);
  vec2 outward = way / max(far, 1e-6);
  ivec2 next = ivec2(vec2(at) + 0.5 + outward);
  float step_out = max(dot(vec2(next - at), outward), 0.5);
  return behind * step_out <= (behind_seen(plane, next) - behind) * far;
}

bool must_be_seen;  // within the rim

// Into an empty sample a splat reaches only if it is seen within its rim: the lining of a sheet, which is hidden there,
// does not show past the sheet.
void silhouettes_bound(inout Candidate c) {
  must_be_seen = c.seen.z > SEES_NOTHING;
}

void silhouettes_opaque_keep(inout Candidate c) {
  if (must_be_seen && !c.in_space && !is_seen_within_rim(c.plane)) discard;
}

#part screen_space.frag, opaque, blend_depth
const float IN_FRONT = 0.1;  // radii by which a plane is nearer than what is seen; blend depths of flat surfaces are less

// Nor does it show past the edge at which it joins the sheet, beyond which its plane is nearer than the sheet.
void silhouettes_joined_bound(inout Candidate c) {
  must_be_seen = must_be_seen || c.seen.z - c.depth > IN_FRONT * c.plane.radius;
}

#part depth_bounds.frag
// Minimum and maximum over the filter's reach in the sample's rows.
void silhouettes_reach(ivec2 texel, inout vec2 row) {
  int last = textureSize(seen_depth, 0).x - 1;
  for (int x = -COLUMN_REACH; x <= COLUMN_REACH; x++) {
    for (int y = 0; y < ROWS; y++) {
      float other = texelFetch(seen_depth, ivec2(clamp(texel.x + x, 0, last), ROWS * texel.y + y), 0).r;
      row = vec2(min(row.x, other), max(row.y, other));
    }
  }
}

#part depth_bounds.frag, writes_depth
void silhouettes_write(ivec2 texel, inout float own) {
  gl_FragDepth = own;
}

#part oit_layer.frag
#include "lib/silhouette_filter.glsl"

void silhouettes_filter(ivec2 texel, vec4 own, inout vec4 seen) {
  ivec2 last = textureSize(shaded, 0) - 1;
  vec4 color = vec4(0.0);
  float total = 0.0;
  for (int y = -FILTER_REACH; y <= FILTER_REACH; y++) {
    for (int x = -COLUMN_REACH; x <= COLUMN_REACH; x++) {
      ivec2 at = clamp(texel + ivec2(x, y), ivec2(0), last);
      float weight = exp(-0.5 * float(y * y) / view.filter_variance) * (x == 0 ? 1.0 : column_ratio());
      vec4 here = texelFetch(shaded, at, 0);
      if (own.w > 0.0) here = own * (here.w / own.w);
      color += weight * let_through(at) * here;
      total += weight;
    }
  }
  seen = color / total;
}
