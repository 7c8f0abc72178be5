// convex_trace: where a ray inside a convex stone meets its surface, from the planes of its facets. Exact: no triangles, no epsilon.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0, hash d66d1893bc224b72
// Source: Imagire, "Proxy Geometry Gem Rendering", section 5, fig. 7, which tests every polygon; Cyrus and Beck, "Generalized two- and
//   three-dimensional clipping", 1978, for planes in place of polygons.
//
// A stone is a list of planes (n, d), n the unit normal outwards: it is where n . x <= d for all of them. A ray leaves it by the
// nearest plane that it runs towards. One trace is a loop over all of them, in ascending order:
//
//   var hit = convex_trace_start(CONVEX_TRACE_FAR);
//   for (var face = 0u; face < count; face += 1u) {
//       hit = convex_trace_step(hit, position, direction, planes[face], face, left);
//   }
//   position = convex_trace_point(position, direction, hit.distance, planes[hit.face]);
//
// Trace in the stone's own coordinates, their origin inside it: errors are units in the last place of positions and of d.

// The nearest plane so far.
struct ConvexTraceHit {
    // Along the ray, at least 0; the limit while none is hit.
    distance: f32,
    // The plane's number; CONVEX_TRACE_NONE while none is hit.
    face: u32,
}

// No face: what `left` is for a ray that starts inside the stone, and `face` where nothing is hit.
const CONVEX_TRACE_NONE: u32 = 0xffffffffu;
// A limit on the distance that no ray in a stone reaches.
const CONVEX_TRACE_FAR: f32 = 1e30f;

// The hit to start from: none, nearer than which a plane must be. A limit makes the ray end there, as an approximation may wish; the
// hit then has no face.
// Returns: ConvexTraceHit without a face, at distance `limit`.
// Units: lengths in units of the ray's direction.
// Domain: limit at least 0; limits beyond 1e30 count as 1e30.
// Outside: from a negative limit on nothing is hit.
// Accuracy: lavapipe distance 0 ulp, face 0 ulp; portable distance 0 ulp, face 0 ulp
fn convex_trace_start(limit: f32) -> ConvexTraceHit {
    return ConvexTraceHit(min(limit, CONVEX_TRACE_FAR), CONVEX_TRACE_NONE);
}

// Takes one plane into account. It is met if the ray runs towards it, however slowly: to a plane that is parallel to the ray the
// slope is 0, or rounding noise, which puts it beyond all others. The face that the ray has just left is told by its
// number: at grazing incidence rounding may turn a ray back towards it, and no distance tells that apart from a true hit. A ray that
// starts outside of a plane by rounding and runs further out meets it at once, at distance 0: so no ray escapes at an edge or a
// vertex. At equal distances the hit stays as it was: in ascending order the lower face wins.
// Returns: this plane's ConvexTraceHit if it is met nearer than `hit`, else `hit`.
// Units: lengths in units of the ray's direction; `plane.xyz` is a unit vector.
// Domain: |direction| = |plane.xyz| = 1; sizes and positions in [1e-4, 1e4], `position` inside up to rounding; slopes of 0 or at least
//   1e-20; `hit` as convex_trace_start and this function give it.
// Outside: finite for sizes up to 1e18; for other directions distances in units of their length.
// Accuracy: lavapipe distance 2 ulp + 2 backward, face 2 backward; portable distance 4 ulp + 4 backward, face 4 backward
fn convex_trace_step(hit: ConvexTraceHit, position: vec3f, direction: vec3f, plane: vec4f, face: u32, left: u32) -> ConvexTraceHit {
    let height = plane.w - dot(plane.xyz, position);
    let slope = dot(plane.xyz, direction);
    // Where the slope is 0 this is not looked at.
    let distance = max(height, 0.0f) / slope;
    if (slope > 0.0f && distance < hit.distance && face != left) {
        return ConvexTraceHit(distance, face);
    }
    return hit;
}

// Where a ray meets a plane, put back onto the plane: x + t r is off it by the rounding of x, t and r, which on a long way is
// more than the plane's own. With a distance of 0 it puts a start, as a rasterizer interpolates it, onto the facet that it belongs to.
// Returns: the point of the plane nearest to position + distance direction.
// Units: lengths; `plane.xyz` is a unit vector.
// Domain: |plane.xyz| = 1, sizes and positions up to 1e4.
// Outside: finite up to 1e18.
// Accuracy: lavapipe 3 ulp + 3 backward; portable 6 ulp + 6 backward
fn convex_trace_point(position: vec3f, direction: vec3f, distance: f32, plane: vec4f) -> vec3f {
    let point = position + distance * direction;
    return point - (dot(plane.xyz, point) - plane.w) * plane.xyz;
}
