//! Whether a mesh encloses anything.

use crate::scene::Mesh;
use glam::DVec3;
use std::collections::HashMap;

/// Corners that lie nearer together than this times the mesh's largest coordinate are one: four times the 2^-24 by which f32 rounds.
/// Where a surface is a grid that closes upon itself, its seam is open by that much.
const TOLERANCE: f64 = 1.0 / (1 << 22) as f64;

/// How many edges have more triangles on one side than on the other; none in a closed mesh.
pub(super) fn open_edges(mesh: &Mesh) -> usize {
    let numbers = weld(mesh);
    let mut balance: HashMap<(usize, usize), i32> = HashMap::new();
    for triangle in mesh.indices.chunks_exact(3) {
        let corner = |k: usize| numbers.get(triangle[k] as usize).copied();
        let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) else { continue };
        for (from, to) in [(a, b), (b, c), (c, a)].into_iter().filter(|(from, to)| from != to) {
            *balance.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
        }
    }
    balance.values().filter(|&&balance| balance != 0).count()
}

/// A number for each position, the same for those that are one.
fn weld(mesh: &Mesh) -> Vec<usize> {
    let positions = || mesh.positions.iter().map(|position| position.as_dvec3());
    let tolerance =
        TOLERANCE * positions().fold(0.0, |largest: f64, position| largest.max(position.abs().max_element()));
    // A cell is twice as wide as the tolerance, so that what is near lies in one of the eight cells about a corner of it.
    let cell =
        |position: DVec3| (position / (2.0 * tolerance).max(f64::MIN_POSITIVE)).floor().to_array().map(|x| x as i64);
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    let mut kept: Vec<DVec3> = Vec::new();
    let number = |position: DVec3| {
        let (least, greatest) = (cell(position - tolerance), cell(position + tolerance));
        let near = (0..8).find_map(|corner| {
            let place = [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { least[axis] } else { greatest[axis] });
            cells.get(&place)?.iter().copied().find(|&number| kept[number].distance(position) <= tolerance)
        });
        near.unwrap_or_else(|| {
            kept.push(position);
            cells.entry(cell(position)).or_default().push(kept.len() - 1);
            kept.len() - 1
        })
    };
    positions().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::scene::surfaces::{sphere, torus};

    #[test]
    fn seams_and_poles_are_no_openings() {
        for mesh in [sphere(40.0, 64), torus(20.0, 7.0, 40, 20)] {
            assert_eq!(open_edges(&mesh), 0);
            // By their bits alone they would be.
            assert!(
                mesh.positions.iter().any(|p| p.abs().max_element() > 1.0
                    && p.abs().min_element() > 0.0
                    && p.abs().min_element() < 1e-10)
            );
        }
        for name in ["skin", "jade_ring", "wax_bunny", "brilliant", "chandelier", "bunny", "dragon", "figure"] {
            let scene = Scene::named(name).expect("built in");
            assert!(scene.objects.iter().all(|object| open_edges(&object.mesh) == 0), "{name}");
        }
    }

    /// At some of the dragon's edges four or more triangles meet, always as many on one side as on the other.
    #[test]
    fn an_edge_with_an_even_number_of_triangles_is_no_opening() {
        let mesh = &Scene::named("dragon").expect("built in").objects[0].mesh;
        let mut triangles: HashMap<(u32, u32), u32> = HashMap::new();
        for triangle in mesh.indices.chunks_exact(3) {
            for k in 0..3 {
                let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
                *triangles.entry((from.min(to), from.max(to))).or_default() += 1;
            }
        }
        assert!(triangles.values().any(|&count| count > 2) && triangles.values().all(|count| count % 2 == 0));
        assert_eq!(open_edges(mesh), 0);
        let mut opened = mesh.clone();
        opened.indices.truncate(mesh.indices.len() - 3);
        assert_eq!(open_edges(&opened), 3);
    }

    #[test]
    fn a_missing_or_turned_triangle_opens_three_edges() {
        let mut mesh = sphere(1.0, 32);
        let last = mesh.indices.split_off(mesh.indices.len() - 3);
        assert_eq!(open_edges(&mesh), 3);
        mesh.indices.extend([last[0], last[2], last[1]]);
        assert_eq!(open_edges(&mesh), 3);
        assert_eq!(open_edges(&Mesh::default()), 0);
    }
}
