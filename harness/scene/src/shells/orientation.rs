//! Windings that agree: neighbours over an edge run against each other along it.

use super::surface::{HalfEdge, Surface};

/// No neighbour, or several.
const NONE: u32 = u32::MAX;

/// Turns triangles so that all that are connected over edges of two triangles wind alike, as most of them do. A connected
/// piece with one side only, such as a Möbius strip, stays. Returns how many were turned.
pub(super) fn unify(surface: &mut Surface) -> usize {
    let edges = surface.half_edges();
    // Over each side the neighbour, and whether it winds the other way.
    let mut neighbours = vec![[(NONE, false); 3]; surface.faces.len()];
    let mut agree = true;
    for edge in edges.chunk_by(|one, other| one.ends() == other.ends()) {
        let [one, other] = edge else { continue };
        let differs = one.forward == other.forward;
        agree &= !differs;
        for (HalfEdge { face, side, .. }, beyond) in [(one, other), (other, one)] {
            neighbours[*face as usize][usize::from(*side)] = (beyond.face, differs);
        }
    }
    if agree {
        return 0;
    }
    let mut turned: Vec<Option<bool>> = vec![None; surface.faces.len()];
    let mut count = 0;
    for start in 0..surface.faces.len() {
        if turned[start].is_some() {
            continue;
        }
        turned[start] = Some(false);
        let (mut piece, mut next, mut is_twisted) = (vec![start], 0, false);
        while let Some(&face) = piece.get(next) {
            next += 1;
            let own = turned[face] == Some(true);
            for (beyond, differs) in neighbours[face].into_iter().filter(|(beyond, _)| *beyond != NONE) {
                let wanted = own != differs;
                match &mut turned[beyond as usize] {
                    Some(known) => is_twisted |= *known != wanted,
                    unknown => {
                        *unknown = Some(wanted);
                        piece.push(beyond as usize);
                    }
                }
            }
        }
        if is_twisted {
            continue;
        }
        let other = piece.iter().filter(|&&face| turned[face] == Some(true)).count();
        let fewer = 2 * other <= piece.len();
        for face in piece.into_iter().filter(|&face| turned[face] == Some(fewer)) {
            surface.faces[face].turn();
            count += 1;
        }
    }
    count
}
