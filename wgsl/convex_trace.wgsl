// convex_trace: where a ray in a convex stone meets its surface, from facet planes. Exact: no triangles, no epsilon.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Imagire, "Proxy Geometry Gem Rendering", section 5, fig. 7, which tests every polygon;
//   Cyrus and Beck, "Generalized two- and three-dimensional clipping", 1978, for planes in place of
//   polygons.
//
// A stone is a list of planes (n, d), where n is the outward unit normal. A point x is inside the
// stone if n . x <= d for all planes. A ray leaves the stone through the nearest of the planes that
// it runs towards. One trace is a loop over all planes, in ascending order:
//
//   var hit = convex_trace_start(CONVEX_TRACE_FAR);
//   for (var face = 0u; face < count; face += 1u) {
//       hit = convex_trace_step(hit, position, direction, planes[face], face, left);
//   }
//   position = convex_trace_point(position, direction, hit.distance, planes[hit.face]);
//
// Trace in the stone's own coordinates, with the origin inside the stone: errors are units in the
// last place of positions and of d.

// The hit on the nearest plane so far.
struct ConvexTraceHit {
    // Distance along the ray, at least 0; the limit while no plane is hit.
    distance: f32,
    // Index of the plane; CONVEX_TRACE_NONE while no plane is hit.
    face: u32,
}

// No face: the value of `left` for a ray that starts inside the stone, and of `face` if nothing is
// hit.
const CONVEX_TRACE_NONE: u32 = 0xffffffffu;
// A limit on the distance, beyond the length of any ray inside a stone.
const CONVEX_TRACE_FAR: f32 = 1e30f;

// The initial hit: no face yet, and a limit that a plane must be nearer than. A shorter limit ends
// the ray there, which can be useful for an approximation; the hit then has no face.
// Returns: ConvexTraceHit without a face, at distance `limit`.
// Units: lengths are in units of the length of the ray's direction.
// Domain: limit at least 0; limits beyond 1e30 count as 1e30.
// Outside: from a negative limit on nothing is hit.
// Accuracy: lavapipe distance 0 ulp, face 0 ulp; portable distance 0 ulp, face 0 ulp
fn convex_trace_start(limit: f32) -> ConvexTraceHit {
    return ConvexTraceHit(min(limit, CONVEX_TRACE_FAR), CONVEX_TRACE_NONE);
}

// Updates the hit with one plane, which the ray meets if it runs towards it, however slowly. The face just left
// is known by its index: no distance tells it from a true hit. At equal distances the earlier hit is kept.
// Returns: this plane's ConvexTraceHit if the ray meets it at a shorter distance than `hit`, otherwise `hit`.
// Units: lengths are in units of the length of the ray's direction; `plane.xyz` is a unit vector.
// Domain: |direction| = |plane.xyz| = 1; sizes and positions in [1e-4, 1e4]; `position` inside the stone, up to
//   rounding; slopes of 0 or at least 1e-20; `hit` from convex_trace_start or from this function.
// Outside: finite for sizes up to 1e18; for other directions distances in units of their length.
// Accuracy: lavapipe distance 2 ulp + 2 backward, face 2 backward;
//   portable distance 4 ulp + 4 backward, face 4 backward
fn convex_trace_step(
    hit: ConvexTraceHit, position: vec3f, direction: vec3f, plane: vec4f, face: u32, left: u32
) -> ConvexTraceHit {
    let height = plane.w - dot(plane.xyz, position);
    let slope = dot(plane.xyz, direction);
    // The quotient is ignored if the slope is 0.
    let distance = max(height, 0.0f) / slope;
    if (slope > 0.0f && distance < hit.distance && face != left) {
        return ConvexTraceHit(distance, face);
    }
    return hit;
}

// Updates the runner-up with one plane's own hit, before the nearest hit takes it up: the plane that
// the ray would meet if the nearest were not there. A list may name a plane twice. A nearest without a
// face is a limit, and no plane that could become the runner-up.
// Returns: the second of the three by distance; of one plane's hits, one counts.
// Units: those of the hits.
// Domain: distances of 0 or in [1e-30, 1e30]; hits of convex_trace_step on planes of their own, except
//   that `hit` may repeat one; runner_up no nearer than nearest.
// Outside: a runner-up nearer than the nearest stays unless the nearest is overtaken.
// Accuracy: lavapipe distance 0 ulp, face 0 ulp; portable distance 0 ulp, face 0 ulp
fn convex_trace_runner_up(nearest: ConvexTraceHit, runner_up: ConvexTraceHit, hit: ConvexTraceHit) -> ConvexTraceHit {
    // Without branches, which in a loop would take longer.
    let overtakes = hit.distance < nearest.distance;
    let second = hit.distance < runner_up.distance && hit.face != nearest.face && !overtakes;
    let overtaken = overtakes && nearest.face != CONVEX_TRACE_NONE;
    let distance = select(runner_up.distance, hit.distance, second);
    let face = select(runner_up.face, hit.face, second);
    return ConvexTraceHit(select(distance, nearest.distance, overtaken), select(face, nearest.face, overtaken));
}

// Point at which a ray meets a plane, moved back onto the plane. The rounding of x, t and r moves
// x + t r off the plane, on a long path by more than the plane's own rounding. With a distance of 0
// the function moves a start point, as interpolated by a rasterizer, onto the facet that it belongs
// to.
// Returns: the point of the plane nearest to position + distance direction.
// Units: lengths; `plane.xyz` is a unit vector.
// Domain: |plane.xyz| = 1, sizes and positions up to 1e4.
// Outside: finite up to 1e18.
// Accuracy: lavapipe 3 ulp + 3 backward; portable 6 ulp + 6 backward
fn convex_trace_point(position: vec3f, direction: vec3f, distance: f32, plane: vec4f) -> vec3f {
    let point = position + distance * direction;
    return point - (dot(plane.xyz, point) - plane.w) * plane.xyz;
}
