//! Bodies of voxels with seeds, made on the CPU.

use glam::{UVec3, Vec3};
use lapidary_assay::draws::Draws;
use lapidary_optical_path::kernels::Body;
use lapidary_optical_path::{OPTICAL_PATH_UNREACHED, seed};
use lapidary_render::voxel_grid::VoxelGrid;
use lapidary_scene::{Bounds, Scene};

/// A body in a grid, with its seeds.
#[derive(Clone, Debug)]
pub struct Case {
    pub grid: VoxelGrid,
    /// Whether there is matter, by voxel.
    pub matter: Vec<bool>,
    /// Factor on the extinction, by voxel.
    pub density: Vec<f32>,
    /// Seeded cost, by voxel.
    pub seeds: Vec<f32>,
    pub extinction: f32,
}

impl Case {
    /// Returns a cube of `cells` voxels 1 wide, with matter as `is_matter` says and no seeds.
    pub fn of(cells: u32, extinction: f32, is_matter: impl Fn(UVec3) -> bool) -> Self {
        let grid = VoxelGrid { origin: Vec3::ZERO, spacing: 1.0, cells };
        let matter: Vec<bool> = (0..grid.count()).map(|index| is_matter(grid.voxel(index))).collect();
        let (density, seeds) = (vec![1.0; matter.len()], vec![OPTICAL_PATH_UNREACHED; matter.len()]);
        Self { grid, matter, density, seeds, extinction }
    }

    /// Returns a union of balls with holes: voxels 1 wide, extinctions up to 1, and scattered
    /// seeds. If `heterogeneous`, the density varies by voxel.
    pub fn random(seed: u64, cells: u32, heterogeneous: bool) -> Self {
        let mut draws = Draws::of_row(seed, 0);
        let side = cells as f32;
        let balls: Vec<(Vec3, f32)> =
            (0..6).map(|_| (0.5 * side * (draws.in_cube() + 1.0), side * draws.between(0.15, 0.4))).collect();
        let holes: Vec<u32> = (0..(cells as usize).pow(3)).map(|_| draws.below(12)).collect();
        let mut case = Self::of(cells, 0.5, |voxel| {
            let centre = voxel.as_vec3() + 0.5;
            let index = voxel.x + cells * (voxel.y + cells * voxel.z);
            holes[index as usize] > 0 && balls.iter().any(|(middle, radius)| centre.distance(*middle) < *radius)
        });
        for index in 0..case.matter.len() {
            if heterogeneous {
                case.density[index] = draws.between(0.0, 2.0) * draws.pick(&[1.0, 1.0, 0.0]);
            }
            if draws.below(200) == 0 {
                case.seeds[index] = draws.between(0.0, 3.0);
            }
        }
        case
    }

    /// Returns the bunny, lit along x, `depth` optical depths wide.
    pub fn bunny(cells: u32, depth: f32) -> Self {
        let scene = Scene::named("skin_bunny").expect("a built-in scene");
        let mesh = &scene.objects[0].mesh;
        let grid = VoxelGrid::about(Bounds::of(mesh.positions.iter().copied()), cells);
        let side = cells as usize;
        let mut matter = vec![false; grid.count()];
        // Each triangle flips the voxels behind it. Rays pass slightly off the voxel centres, so
        // that they meet no edge.
        for corners in mesh.triangles() {
            let [a, b, c] = corners.map(|corner| ((corner - grid.origin) / grid.spacing).as_dvec3());
            let least = a.min(b).min(c).floor().max(glam::DVec3::ZERO);
            let most = a.max(b).max(c).ceil().min(glam::DVec3::splat(f64::from(cells)));
            for z in least.z as usize..most.z as usize {
                for y in least.y as usize..most.y as usize {
                    let (py, pz) = (y as f64 + 0.5 + 1.234e-7, z as f64 + 0.5 + 3.21e-8);
                    let area = |p: glam::DVec3, q: glam::DVec3| (q.y - p.y) * (pz - p.z) - (q.z - p.z) * (py - p.y);
                    let [u, v, w] = [area(b, c), area(c, a), area(a, b)];
                    if (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0) {
                        let x = (u * a.x + v * b.x + w * c.x) / (u + v + w);
                        let first = (x - 0.5).ceil().max(0.0) as usize;
                        for x in first..side {
                            let index = x + side * (y + side * z);
                            matter[index] = !matter[index];
                        }
                    }
                }
            }
        }
        let mut case = Self {
            grid,
            density: vec![1.0; matter.len()],
            seeds: vec![OPTICAL_PATH_UNREACHED; matter.len()],
            extinction: depth / (grid.spacing * cells as f32),
            matter,
        };
        for row in 0..side * side {
            if let Some(x) = (0..side).find(|x| case.matter[x + side * row]) {
                case.seeds[x + side * row] =
                    seed(0.25 + 0.5 * (row % 7) as f32 / 7.0, case.extinction, 0.3 * grid.spacing);
            }
        }
        case
    }

    /// Returns the case for the kernels' mirrors, with these extinctions.
    pub fn body<'a>(&'a self, extinction: &'a [f32]) -> Body<'a> {
        Body { cells: self.grid.cells, spacing: self.grid.spacing, matter: &self.matter, extinction }
    }

    /// Returns each voxel's extinction.
    pub fn extinctions(&self) -> Vec<f32> {
        self.density.iter().map(|density| self.extinction * density).collect()
    }

    /// Returns a bit for each voxel, in rows of words.
    pub fn bits(&self) -> Vec<u32> {
        let words = self.grid.words_per_row() as usize;
        let side = self.grid.cells as usize;
        let mut bits = vec![0u32; words * side * side];
        for (index, _) in self.matter.iter().enumerate().filter(|(_, matter)| **matter) {
            bits[words * (index / side) + index % side / 32] |= 1 << (index % side % 32);
        }
        bits
    }
}
