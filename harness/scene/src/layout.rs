//! Layout of a mesh in its texture: its charts, and the edges where the texture closes on itself.

use std::collections::HashMap;

use glam::{BVec2, Vec2};

use super::Mesh;

/// Where a mesh's charts lie.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Whether the surface continues across the texture's edges, along u and along v: vertices on
    /// one edge have counterparts at the same place on the other.
    pub repeats: BVec2,
    /// Lower and upper corner of each chart's box in texture coordinates. A chart consists of
    /// triangles connected through common vertices, halos included.
    pub charts: Vec<[Vec2; 2]>,
}

impl Layout {
    /// Returns the layout of a mesh with texture coordinates for each vertex.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Self {
        Self { repeats: repeats(mesh), charts: charts(mesh) }
    }
}

fn repeats(mesh: &Mesh) -> BVec2 {
    let along = |axis: usize| {
        let edge = |end: f32| {
            let on_edge = mesh.uvs.iter().zip(&mesh.positions).filter(move |(uv, _)| uv[axis] == end);
            // Adding zero turns -0 into 0 and nothing else.
            on_edge
                .map(move |(uv, position)| (uv[1 - axis].to_bits(), position.to_array().map(|x| (x + 0.0).to_bits())))
        };
        let [mut first, mut last]: [Vec<_>; 2] = [edge(0.0).collect(), edge(1.0).collect()];
        first.sort_unstable();
        last.sort_unstable();
        !first.is_empty() && first == last
    };
    BVec2::new(along(0), along(1))
}

fn charts(mesh: &Mesh) -> Vec<[Vec2; 2]> {
    let mut parent: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    fn root(parent: &mut [u32], mut vertex: u32) -> u32 {
        while parent[vertex as usize] != vertex {
            let above = parent[parent[vertex as usize] as usize];
            parent[vertex as usize] = above;
            vertex = above;
        }
        vertex
    }
    for triangle in mesh.indices.chunks_exact(3).chain(mesh.halo.chunks_exact(3)) {
        let [a, b, c] = [0, 1, 2].map(|k| root(&mut parent, triangle[k]));
        parent[b as usize] = a;
        let c = root(&mut parent, c);
        parent[c as usize] = a;
    }
    let mut boxes: HashMap<u32, [Vec2; 2]> = HashMap::new();
    for &vertex in mesh.indices.iter().chain(&mesh.halo) {
        let uv = mesh.uvs[vertex as usize];
        let [low, high] = boxes.entry(root(&mut parent, vertex)).or_insert([uv, uv]);
        (*low, *high) = (low.min(uv), high.max(uv));
    }
    let mut boxes: Vec<[Vec2; 2]> = boxes.into_values().collect();
    boxes.sort_by(|a, b| a[0].y.total_cmp(&b[0].y).then(a[0].x.total_cmp(&b[0].x)));
    boxes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use crate::surfaces::{sphere, torus};

    #[test]
    fn a_sphere_closes_around_and_a_torus_both_ways() {
        let whole = vec![[Vec2::ZERO, Vec2::ONE]];
        assert_eq!(Layout::of(&sphere(1.0, 32)), Layout { repeats: BVec2::new(true, false), charts: whole.clone() });
        assert_eq!(Layout::of(&torus(2.0, 1.0, 32, 16)), Layout { repeats: BVec2::TRUE, charts: whole });
    }

    #[test]
    fn the_bunnys_charts_are_apart() {
        let scene = Scene::named("wax_bunny").expect("built in");
        let Layout { repeats, charts } = Layout::of(&scene.objects[0].mesh);
        assert_eq!(repeats, BVec2::FALSE);
        assert!(charts.len() > 1);
        for (k, [low, high]) in charts.iter().enumerate() {
            for [other_low, other_high] in &charts[k + 1..] {
                let gap = (*other_low - *high).max(*low - *other_high).max_element();
                assert!(gap >= 7.9 / 1024.0, "{gap}");
            }
        }
    }
}
