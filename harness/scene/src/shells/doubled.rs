//! Triangles that are there twice.

use std::collections::HashMap;

use super::surface::{Face, Surface};

/// Leaves out triangles beyond the first with the same corners and winding. Of two of opposite winding the one stays to which
/// all neighbours fit, or the first if there are no neighbours but such pairs; else both stay, as the common wall of two
/// bodies. Returns how many were left out.
pub(super) fn remove(surface: &mut Surface) -> usize {
    let before = surface.faces.len();
    let mut order: Vec<u32> = (0..before as u32).collect();
    let key = |surface: &Surface, face: u32| {
        let mut places = surface.faces[face as usize].places;
        places.sort_unstable();
        places
    };
    order.sort_by_key(|&face| (key(surface, face), face));
    let mut kept = vec![true; before];
    // Both windings of the same corners.
    let mut pairs: Vec<[u32; 2]> = Vec::new();
    for same in order.chunk_by(|&one, &other| key(surface, one) == key(surface, other)) {
        let is_even = |face: u32| winding(&surface.faces[face as usize]);
        let first = same[0];
        let other = same.iter().copied().find(|&face| is_even(face) != is_even(first));
        same.iter().filter(|&&face| face != first && Some(face) != other).for_each(|&face| kept[face as usize] = false);
        pairs.extend(other.map(|other| [first, other]));
    }
    if !pairs.is_empty() {
        resolve(surface, &pairs, &mut kept);
    }
    surface.retain(|face| kept[face as usize]);
    before - surface.faces.len()
}

/// Whether the places run upwards, but for where they begin.
fn winding(face: &Face) -> bool {
    let [a, b, c] = face.places;
    [a < b, b < c, c < a].into_iter().filter(|rises| *rises).count() == 2
}

/// Decides which of two triangles of opposite winding stays.
fn resolve(surface: &Surface, pairs: &[[u32; 2]], kept: &mut [bool]) {
    let mut is_paired = vec![false; kept.len()];
    pairs.iter().flatten().for_each(|&face| is_paired[face as usize] = true);
    // Number of others at each edge of a pair, and how many more of them run from low to high.
    let mut others: HashMap<(u32, u32), (u32, i32)> = HashMap::new();
    let sides = |face: &Face| [0, 1, 2].map(|side| (face.places[side], face.places[(side + 1) % 3]));
    for &[first, _] in pairs {
        for (from, to) in sides(&surface.faces[first as usize]) {
            others.insert((from.min(to), from.max(to)), (0, 0));
        }
    }
    let others_of =
        surface.faces.iter().zip(kept.iter().zip(&is_paired)).filter(|(_, (kept, paired))| **kept && !**paired);
    for (face, _) in others_of {
        for (from, to) in sides(face) {
            if let Some((count, balance)) = others.get_mut(&(from.min(to), from.max(to))) {
                *count += 1;
                *balance += if from < to { 1 } else { -1 };
            }
        }
    }
    for &[first, other] in pairs {
        // 1 at each side if the first closes the gap there, -1 if the other does.
        let wanted = sides(&surface.faces[first as usize]).map(|(from, to)| {
            let (count, balance) = others[&(from.min(to), from.max(to))];
            (count, if from < to { -balance } else { balance })
        });
        if wanted.iter().all(|(_, wanted)| *wanted == -1) {
            kept[first as usize] = false;
        } else if wanted.iter().all(|(_, wanted)| *wanted == 1) || wanted.iter().all(|(count, _)| *count == 0) {
            kept[other as usize] = false;
        }
    }
}
