//! Walls inside a solid: pieces whose rim lies on edges of its surface, where three triangles meet.

use super::components::Sets;
use super::nesting::goes_around;
use super::surface::{HalfEdge, Surface};

/// Number of pieces that are looked at, and products of pieces and triangles.
const MOST_PIECES: usize = 64;
const MOST_PRODUCTS: usize = 1 << 26;

/// Leaves out pieces without which all edges at their rim have two triangles that run against each other, and which then lie
/// inside. Returns the number of triangles that were left out.
pub(super) fn remove(surface: &mut Surface) -> usize {
    let edges = surface.half_edges();
    let chunks = || edges.chunk_by(|one, other| one.ends() == other.ends());
    let is_odd = |edge: &&[HalfEdge]| edge.len() > 2 && edge.iter().map(HalfEdge::sign).sum::<i32>() != 0;
    if !chunks().any(|edge| is_odd(&edge)) {
        return 0;
    }
    let mut pieces = Sets::new(surface.faces.len());
    let mut clusters = Sets::new(surface.faces.len());
    for edge in chunks() {
        if let [one, other] = edge {
            pieces.join(one.face, other.face);
        }
        edge.windows(2).for_each(|pair| clusters.join(pair[0].face, pair[1].face));
    }
    // Pieces at edges where the sum is odd.
    let mut candidates: Vec<u32> = chunks().filter(is_odd).flatten().map(|half| pieces.root(half.face)).collect();
    candidates.sort_unstable();
    candidates.dedup();
    candidates.truncate(MOST_PIECES);
    let mut is_left_out = vec![false; surface.faces.len()];
    let mut products = MOST_PRODUCTS;
    for piece in candidates {
        let whole = clusters.root(piece);
        let mut closes = |edge: &[HalfEdge]| {
            let (own, rest): (Vec<&HalfEdge>, Vec<&HalfEdge>) = edge
                .iter()
                .filter(|half| !is_left_out[half.face as usize])
                .partition(|half| pieces.root(half.face) == piece);
            let fits = rest.len() == 2 && rest.iter().map(|half| half.sign()).sum::<i32>() == 0;
            own.is_empty() || own.len() == 2 && rest.is_empty() || fits
        };
        if !chunks().all(&mut closes) {
            continue;
        }
        let faces = 0..surface.faces.len() as u32;
        let (own, rest): (Vec<u32>, Vec<u32>) = faces
            .filter(|&face| !is_left_out[face as usize] && clusters.root(face) == whole)
            .partition(|&face| pieces.root(face) == piece);
        let Some(left) = products.checked_sub(own.len() * rest.len()) else { break };
        products = left;
        let middle = |&face: &u32| surface.corners(face).iter().sum::<glam::DVec3>() / 3.0;
        if own.iter().map(middle).all(|point| goes_around(surface, &rest, point)) {
            own.into_iter().for_each(|face| is_left_out[face as usize] = true);
        }
    }
    let before = surface.faces.len();
    surface.retain(|face| !is_left_out[face as usize]);
    before - surface.faces.len()
}
