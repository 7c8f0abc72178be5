// convex_walk: the facet through which a ray leaves a convex stone, in a few steps over a map of the facets. Exact.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: own. The square: Meyer, Süßmuth, Sußner, Stamminger and Greiner, "On Floating-Point Normal
//   Vectors", 2010 (octahedral coordinates). For the planes: the module convex_trace.
//
// The origin lies inside the stone. All directions from it, as a square divided into cells, form the
// map: each cell lists every facet that is seen from the origin through it, its candidates. Within
// the cone of a cell, the stone is the intersection of its candidates' half-spaces alone. So a point
// of the ray that lies outside the stone lies outside a candidate of its cell, and the ray meets that
// plane earlier. From a point beyond the stone the walk comes nearer with every step, and ends at
// the facet that a loop over all planes finds, with no epsilon and no neighbours to know:
//
//   var hit = convex_trace_start(convex_walk_exit(position, direction, lower, upper));
//   var before = hit.face;
//   var place = convex_walk_cell(convex_walk_square(position + hit.distance * direction), side);
//   for (var step = 0u; step < CONVEX_WALK_STEPS; step++) {
//       let word = map[place];
//       let more = word >= CONVEX_WALK_MORE;
//       let rest = (word >> CONVEX_WALK_SHIFT) & CONVEX_WALK_PLACE;
//       let first = word & CONVEX_WALK_FACE;
//       let second = select(rest, first, more);
//       hit = convex_trace_step(hit, position, direction, planes[first], first, left);
//       hit = convex_trace_step(hit, position, direction, planes[second], second, left);
//       if (more) {
//           place = rest;
//       } else {
//           if (hit.face == before) {
//               break;
//           }
//           before = hit.face;
//           place = convex_walk_cell(convex_walk_square(position + hit.distance * direction), side);
//       }
//   }
//
// `lower` and `upper` are the corners of a box around the stone, a little larger than it. The map
// has a word for each cell, side * side of them, and further words behind them. The last word of a
// cell holds its last two candidates, or its only one twice. A cell with more candidates begins with
// words that hold one each, and the place of the next word. The crate's FacetMap makes the map and
// the box from the planes.

// The bits of a word that hold a facet's number: at most 4096 facets.
const CONVEX_WALK_FACE: u32 = 0xfffu;
// The bits below a word's second part: another facet's number or, with CONVEX_WALK_MORE, the place
// of the next word.
const CONVEX_WALK_SHIFT: u32 = 12u;
// The bits of the second part, after the shift.
const CONVEX_WALK_PLACE: u32 = 0x7ffffu;
// The bit of a word that another follows.
const CONVEX_WALK_MORE: u32 = 0x80000000u;
// Most words that a walk may read, four cells that list all facets. It needs a few: it ends by
// itself, since each pass over a cell is to a facet nearer than the one before.
const CONVEX_WALK_STEPS: u32 = 16384u;
// Slope below which a ray is parallel to a side of the box.
const CONVEX_WALK_PARALLEL: f32 = 1e-20f;

// Distance at which a ray leaves a box. A walk starts there: beyond the stone, and not far from it.
// Returns: distance along the ray to the first of the three sides ahead; 0 from a start beyond it.
// Units: lengths are in units of the length of the ray's direction.
// Domain: |direction| = 1, components of 0 or at least 1e-20; `position` in the box, up to rounding;
//   corners and positions 0 or in [1e-4, 1e4].
// Outside: finite for positions and corners up to 1e18; from a start beyond the side, 0.
// Accuracy: lavapipe 2 ulp; portable 6 ulp
fn convex_walk_exit(position: vec3f, direction: vec3f, lower: vec3f, upper: vec3f) -> f32 {
    let height = select(position - lower, upper - position, direction > vec3f(0.0f));
    let slope = max(abs(direction), vec3f(CONVEX_WALK_PARALLEL));
    let distance = max(height, vec3f(0.0f)) / slope;
    return min(min(distance.x, distance.y), distance.z);
}

// Octahedral coordinates of a point's direction from the origin. Points with z >= 0 map to the
// square's inner half |x| + |y| <= 1, with z at its centre, and the others to the corners. A
// component of 0 belongs to the positive side; sign() would be 0 there, and would take the direction
// -z, that of a stone's culet, for +z, that of its table.
// Returns: coordinates in [-1, 1].
// Units: none; the length of `point` does not matter.
// Domain: a largest component in [1e-18, 1e18], others 0 or at least 1e-30 in magnitude.
// Outside: finite up to 1e37, also at the origin.
// Accuracy: lavapipe 3e-7 abs; portable 9e-7 abs
fn convex_walk_square(point: vec3f) -> vec2f {
    let sum = max(abs(point.x) + abs(point.y) + abs(point.z), 1e-37f);
    let inner = point.xy / sum;
    if (point.z >= 0.0f) {
        return inner;
    }
    let outer = 1.0f - abs(inner.yx);
    return select(-outer, outer, point.xy >= vec2f(0.0f));
}

// The cell of the map that holds a place on the square. Counted from the middle, where a product is
// exact to a last place; counted from a corner, a small negative coordinate would round into the
// next cell.
// Returns: the cell's number, x + side y.
// Units: none.
// Domain: coordinates in [-1, 1], `side` even, from 2 to 4096.
// Outside: coordinates beyond the square count as on its edge.
// Accuracy: lavapipe 1 backward; portable 2 backward
fn convex_walk_cell(square: vec2f, side: u32) -> u32 {
    let half_side = f32(side / 2u);
    let place = clamp(floor(square * half_side), vec2f(-half_side), vec2f(half_side - 1.0f));
    let cell = vec2u(place + half_side);
    return cell.x + side * cell.y;
}
