// Sizes of filter kernels in hemispherical maps of area lights.

struct Kernel {
  int cluster;
  vec2 center;       // in the map, [0, 1]
  float radius2;     // squared radius of the direction, 0 on the axis, 1 at the horizon
  float distance_m;  // of the receiver
  float depth;       // of the receiver, in the map's units
  vec3 local;        // the receiver in the map's frame, m
  vec3 normal;       // its normal there, unit length
};

uniform float search_scale;

const float kHalfTurn = 3.14159265358979;
const float kLeastBlocker = 1.0e-4;  // depth of a blocker, so that its penumbra is finite; ours

// Width in the map, [0, 1], of an angle.
// KERNEL_CONFORMAL: a small angle at the radius r spans angle (1 + r2) / 4 of the map (derived from
// the stereographic projection, dr / dtheta = (1 + r2) / 2). Else angle / pi everywhere
// (Dong et al. 2009, Sec. 4.2).
float map_width(float angle, Kernel kernel) {
#ifdef KERNEL_CONFORMAL
  return angle * (1.0 + kernel.radius2) * 0.25;
#else
  return angle / kHalfTurn;
#endif
}

const float kSteepest = 0.1;  // cosine at which a receiver's slope ends to grow; ours

// What the receiver's plane rises from a box's centre to its edge, in receiver's depths (ours).
// width: of the box, at least a texel of a map of size_px.
float plane_rise(Kernel kernel, float width, int size_px) {
  float cosine = abs(dot(kernel.local, kernel.normal)) / kernel.distance_m;
  float slope = sqrt(max(1.0 - cosine * cosine, 0.0)) / max(cosine, kSteepest);
  float half_angle = 2.0 * max(width, 1.0 / float(size_px)) / (1.0 + kernel.radius2);
  return slope * half_angle;
}

// Region in which blockers are looked for: the angle under which the receiver sees the light, times
// search_scale (ours; Dong et al. 2009, Sec. 4.2 say "from the solid angle"). Exact for blockers
// halfway, too small for nearer ones.
// seen_m2: the light's area as the receiver sees it.
float search_width(float seen_m2, Kernel kernel) {
  return min(map_width(search_scale * atan(sqrt(max(seen_m2, 0.0)), kernel.distance_m), kernel),
             1.0);
}

// Dong et al. 2009, Sec. 4.2: p cos(beta) = (d - z_avg) size / z_avg; alpha = atan(p cos(beta) / d).
float penumbra_width(float size_m, float blocker, Kernel kernel) {
  float penumbra_m = (kernel.depth - blocker) * size_m / max(blocker, kLeastBlocker);
  return min(map_width(atan(penumbra_m, kernel.distance_m), kernel), 1.0);
}
