use super::cells::{self, Cells};
use super::levels::Levels;
use super::matter::Matter;
use super::tiles::Tiles;
use crate::frame::{Buffer, Builder, Executor};
use crate::objects::mesh_buffers::ShapeBuffers;
use crate::settings::DiffusionOptions;
use crate::volume::voxel_grid::VoxelGrid;
use glam::{DQuat, DVec3, Vec3};
use lapidary_gpu::{AdapterChoice, Gpu};
use lapidary_scene::surfaces::{rounded_box, sphere};
use lapidary_scene::{Bounds, Material, Medium, Mesh, Object};

fn gpu() -> &'static Gpu {
    Gpu::shared(&AdapterChoice::from_environment()).expect("a device")
}

/// A body's equations, with a right side of one's own.
struct Lone {
    executor: Executor<'static>,
    grid: VoxelGrid,
    levels: Levels,
    faces: Buffer,
    reactions: Buffer,
    nodes: Buffer,
    right: Buffer,
    fluence: Buffer,
}

impl Lone {
    /// Sets up a body of grey matter, of this extinction and share of absorption.
    fn of(mesh: Mesh, cells: u32, matter: (f32, f32), cycles: u32) -> Self {
        Self::with(
            mesh,
            cells,
            matter,
            (DiffusionOptions { cycles, most_cycles: cycles, residual: true, ..DiffusionOptions::default() }, false),
        )
    }

    /// The same, with other options and perhaps with the flux limiter.
    fn with(
        mesh: Mesh,
        cells: u32,
        (extinction, absorbed): (f32, f32),
        (options, is_limited): (DiffusionOptions, bool),
    ) -> Self {
        let medium = Medium::isotropic(Vec3::splat(extinction * (1.0 - absorbed)), Vec3::splat(extinction * absorbed));
        Self::of_medium(mesh, cells, medium, options, is_limited)
    }

    fn of_medium(mesh: Mesh, cells: u32, medium: Medium, options: DiffusionOptions, is_limited: bool) -> Self {
        let material = Material { medium: Some(medium), ..Material::standard() };
        let object = Object::new("body", mesh, material);
        let mut builder = Builder::new(Some(gpu()));
        let grid = VoxelGrid::about(Bounds::of(object.mesh.positions.iter().copied()), cells);
        let matter = Matter::of(&object.material, grid, 1.0);
        let mesh = ShapeBuffers::of(&mut builder, &object).expect("buffers");
        let tiles = Tiles::new(&mut builder, grid.cells, 0);
        let of_body = cells::Body { matter, material: &object.material, largest: Vec3::ONE, harmonics: None };
        let constants = [("EFFECT_SURFACE", 0.0), ("EFFECT_ENVIRONMENT", 0.0)];
        let cells = Cells::new(&mut builder, grid, (&object.mesh, &mesh), &constants, of_body, (tiles, None));
        let cells = cells.expect("the recipe");
        let limited = is_limited.then_some(matter.extinction);
        let levels = Levels::new(&mut builder, grid, &cells, limited, options).expect("the recipe");
        cells.encode_voxels(&mut builder);
        cells.encode(&mut builder);
        levels.encode_equations(&mut builder);
        levels.encode(&mut builder);
        let (faces, reactions, nodes) = (cells.faces, cells.reactions, cells.nodes);
        let (right, fluence) = (levels.right(), levels.fluence());
        let executor = Executor::new(gpu(), builder.finish()).expect("made");
        // Once, for the volumes.
        executor.run(|_, _| {}).expect("run");
        Self { executor, grid, levels, faces, reactions, nodes, right, fluence }
    }

    fn floats(&self, buffer: Buffer) -> Vec<f64> {
        self.executor.words(buffer).expect("read").into_iter().map(|word| f64::from(f32::from_bits(word))).collect()
    }

    /// Filled volume of each voxel, as a share of it.
    fn volumes(&self) -> Vec<f64> {
        self.floats(self.reactions).chunks_exact(4).map(|reaction| reaction[3]).collect()
    }

    /// Returns each node's position.
    fn places(&self) -> Vec<DVec3> {
        let words = self.executor.words(self.nodes).expect("read");
        let place = |(index, word): (usize, u32)| {
            let parts: Vec<u32> = (0..8).filter(|part| word >> part & 1 == 1).collect();
            let sum: DVec3 = parts
                .iter()
                .map(|part| {
                    DVec3::new(f64::from(part & 1), f64::from(part >> 1 & 1), f64::from(part >> 2)) * 0.5 - 0.25
                })
                .sum();
            let centroid = sum / parts.len().max(1) as f64;
            self.grid.centre(self.grid.voxel(index)).as_dvec3() + f64::from(self.grid.spacing) * centroid
        };
        words.into_iter().enumerate().map(place).collect()
    }

    /// Solves for a grey right side, one number for each voxel.
    fn solve(&self, right: &[f64]) -> Vec<f64> {
        let [first, ..] = self.solve_all(right);
        first
    }

    /// The same, with the fluence of each channel.
    fn solve_all(&self, right: &[f64]) -> [Vec<f64>; 3] {
        let spread: Vec<f32> = right.iter().flat_map(|value| [*value as f32; 4]).collect();
        self.executor.write_buffer(self.right, bytemuck::cast_slice(&spread)).expect("written");
        self.executor.run(|_, _| {}).expect("run");
        let all = self.floats(self.fluence);
        [0, 1, 2].map(|channel| all.chunks_exact(4).map(|voxel| voxel[channel]).collect())
    }

    /// Returns the sums of the magnitudes of the equations' terms over the right side, both as root mean squares.
    fn terms(&self, right: &[f64], fluence: &[f64]) -> f64 {
        let (faces, reactions) = (self.floats(self.faces), self.floats(self.reactions));
        let cells = self.grid.cells as usize;
        let mut terms: Vec<f64> = right.iter().map(|load| load.abs()).collect();
        for (index, voxel) in (0..right.len()).map(|index| (index, self.grid.voxel(index).to_array())) {
            terms[index] += reactions[4 * index] * fluence[index];
            for (axis, stride) in [1, cells, cells * cells].into_iter().enumerate() {
                if voxel[axis] + 1 < self.grid.cells {
                    let flow = faces[3 * index + axis] * (fluence[index + stride] + fluence[index]);
                    terms[index] += flow;
                    terms[index + stride] += flow;
                }
            }
        }
        let square = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
        (square(&terms) / square(right)).sqrt()
    }

    /// Returns what is left of the equations, over the right side, both as root mean squares; and the
    /// share of what is put in that neither leaves nor is absorbed.
    fn residual(&self, right: &[f64], fluence: &[f64]) -> (f64, f64) {
        self.residual_of(&self.floats(self.faces), 0, right, fluence)
    }

    /// Returns the conductances with the flux limiter for this fluence, and the least factor. `extinction` is that of a voxel
    /// spacing.
    fn limited(&self, extinction: f32, fluence: &[f64]) -> (Vec<f64>, f64) {
        let (mut faces, nodes) = (self.floats(self.faces), self.executor.words(self.nodes).expect("read"));
        let cells = self.grid.cells as usize;
        let mut slowest = 1.0f64;
        for (place, face) in faces.iter_mut().enumerate().filter(|(_, face)| **face > 0.0) {
            let (lower, axis) = (place / 3, place % 3);
            let upper = lower + [1, cells, cells * cells][axis];
            let mask = [0x55, 0x33, 0x0f][axis];
            let open = f64::from(((nodes[lower] & 255) >> (1 << axis) & nodes[upper] & mask).count_ones()) / 4.0;
            let thickness = extinction * (open / *face) as f32;
            let factor = lapidary_diffusion::limit(fluence[lower] as f32, fluence[upper] as f32, thickness).into();
            *face *= factor;
            slowest = slowest.min(factor);
        }
        (faces, slowest)
    }

    fn residual_of(&self, faces: &[f64], channel: usize, right: &[f64], fluence: &[f64]) -> (f64, f64) {
        let reactions = self.floats(self.reactions);
        let cells = self.grid.cells as usize;
        let mut left = right.to_vec();
        let mut lost = 0.0;
        for (index, voxel) in (0..right.len()).map(|index| (index, self.grid.voxel(index).to_array())) {
            left[index] -= reactions[4 * index + channel] * fluence[index];
            lost += reactions[4 * index + channel] * fluence[index];
            for (axis, stride) in [1, cells, cells * cells].into_iter().enumerate() {
                if voxel[axis] + 1 < self.grid.cells {
                    let flow = faces[3 * index + axis] * (fluence[index + stride] - fluence[index]);
                    left[index] += flow;
                    left[index + stride] -= flow;
                }
            }
        }
        let square = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
        let put_in: f64 = right.iter().sum();
        ((square(&left) / square(right)).sqrt(), (1.0 - lost / put_in).abs())
    }
}

/// The iterations of conjugate gradients, preconditioned by the equations' own factors, until `most` of the right
/// side is left.
fn conjugate_gradients(lone: &Lone, right: &[f64], most: f64) -> usize {
    let (faces, reactions) = (lone.floats(lone.faces), lone.floats(lone.reactions));
    let cells = lone.grid.cells as usize;
    let strides = [1, cells, cells * cells];
    let neighbours = |index: usize| {
        let voxel = lone.grid.voxel(index).to_array();
        let faces = &faces;
        (0..3).flat_map(move |axis| {
            let above = (voxel[axis] + 1 < cells as u32).then(|| (index + strides[axis], faces[3 * index + axis]));
            let below = (voxel[axis] > 0).then(|| (index - strides[axis], faces[3 * (index - strides[axis]) + axis]));
            above.into_iter().chain(below)
        })
    };
    let factor = |index: usize| reactions[4 * index] + neighbours(index).map(|(_, face)| face).sum::<f64>();
    let owns: Vec<f64> = (0..right.len()).map(factor).collect();
    let active: Vec<usize> = (0..right.len()).filter(|index| owns[*index] > 0.0).collect();
    let dot = |a: &[f64], b: &[f64]| active.iter().map(|index| a[*index] * b[*index]).sum::<f64>();
    let scaled = |residual: &[f64]| {
        let mut scaled = vec![0.0; residual.len()];
        active.iter().for_each(|index| scaled[*index] = residual[*index] / owns[*index]);
        scaled
    };
    let mut left = right.to_vec();
    let mut direction = scaled(&left);
    let mut product = dot(&left, &direction);
    let enough = most * most * dot(right, right);
    for iteration in 1..10_000 {
        let mut applied = vec![0.0; right.len()];
        for index in &active {
            let inflow: f64 = neighbours(*index).map(|(other, face)| face * direction[other]).sum();
            applied[*index] = owns[*index] * direction[*index] - inflow;
        }
        let step = product / dot(&direction, &applied);
        active.iter().for_each(|index| left[*index] -= step * applied[*index]);
        if dot(&left, &left) <= enough {
            return iteration;
        }
        let next = scaled(&left);
        let after = dot(&left, &next);
        active.iter().for_each(|index| direction[*index] = next[*index] + after / product * direction[*index]);
        product = after;
    }
    10_000
}

/// Light that begins alike everywhere in a ball, at a rate of 1 per volume: the closed form, with
/// Milne's length beyond the surface.
fn in_ball(radius: f64, distance: f64, (extinction, absorbed): (f64, f64)) -> f64 {
    let milne = f64::from(lapidary_diffusion::DIFFUSION_MILNE) / extinction;
    let (r, s) = (radius, distance);
    if absorbed == 0.0 {
        return 0.5 * extinction * (r * r - s * s) + milne * extinction * r;
    }
    let kappa = extinction * (3.0 * absorbed).sqrt();
    let (sinh, cosh) = ((kappa * r).sinh(), (kappa * r).cosh());
    let factor = 1.0 / (sinh / r + milne * (kappa * cosh / r - sinh / (r * r)));
    let profile = if s < 1e-9 { kappa } else { (kappa * s).sinh() / s };
    (1.0 - factor * profile) / (absorbed * extinction)
}

/// The right side for light that begins at a rate of 1 per volume.
fn everywhere(lone: &Lone, extinction: f64) -> Vec<f64> {
    let spacing = f64::from(lone.grid.spacing);
    lone.volumes().into_iter().map(|volume| 3.0 * extinction * spacing * spacing * volume).collect()
}

#[test]
fn a_ball_that_glows_is_as_bright_as_the_closed_form() {
    for (extinction, absorbed, cells) in
        [(10.0, 0.0, 32), (10.0, 0.02, 32), (2.0, 0.0, 32), (40.0, 0.001, 64), (0.05, 0.0, 32), (3.0, 0.01, 40)]
    {
        let lone = Lone::of(sphere(1.0, 96), cells, (extinction as f32, absorbed as f32), 8);
        let right = everywhere(&lone, extinction);
        let fluence = lone.solve(&right);
        let (volumes, places) = (lone.volumes(), lone.places());
        let (mut off, mut all) = (0.0, 0.0);
        for ((volume, place), found) in volumes.iter().zip(&places).zip(&fluence) {
            let expected = in_ball(1.0, place.length().min(1.0), (extinction, absorbed));
            off += volume * (found - expected).powi(2);
            all += volume * expected * expected;
        }
        let error = (off / all).sqrt();
        println!("extinction {extinction}, absorbed {absorbed}, {cells} cells: {error:.4}");
        // Cut cells put the surface within half a voxel.
        let bound = 0.5 * f64::from(lone.grid.spacing);
        assert!(error < bound, "extinction {extinction}, absorbed {absorbed}: {error} of {bound}");
    }
}

#[test]
fn what_is_put_in_leaves_or_is_absorbed() {
    let tilted = rounded_box(DVec3::new(1.0, 0.4, 0.07), 0.02, 3);
    let turn = DQuat::from_rotation_y(0.3) * DQuat::from_rotation_x(0.7);
    for (mesh, matter) in [
        (sphere(1.0, 64), (8.0, 0.0)),
        (sphere(1.0, 64), (8.0, 0.1)),
        (tilted.placed(turn, DVec3::ZERO), (15.0, 0.001)),
        (tilted.placed(turn, DVec3::ZERO), (200.0, 0.0)),
    ] {
        // A cycle leaves a third at most, and the first one, on the coarser grids, is not counted.
        for (cycles, bound, balance) in [(2, 4e-2, 2e-2), (14, 5e-5, 1e-4)] {
            let lone = Lone::of(mesh.clone(), 48, matter, cycles);
            let right = everywhere(&lone, matter.0.into());
            let (residual, unaccounted) = lone.residual(&right, &lone.solve(&right));
            println!("{matter:?}, {cycles} cycles: residual {residual:.1e}, unaccounted {unaccounted:.1e}");
            assert!(residual < bound && unaccounted < balance, "{matter:?}, {cycles}: {residual} {unaccounted}");
            // The device's own sums, in f32: their terms are each rounded twice, and their sums eight times.
            let rounding = 10.0 * f64::from(f32::EPSILON / 2.0) * lone.terms(&right, &lone.solve(&right));
            for told in lone.levels.residual(&lone.executor).expect("read").expect("asked for") {
                let off = (told - residual).abs();
                assert!(off < rounding + 1e-4 * residual, "{matter:?}, {cycles}: {residual} {told} {rounding}");
            }
        }
    }
}

/// In a plate that is lit from below two cycles leave much of the equations: by default more follow until a thousandth is left,
/// and none where two are enough.
#[test]
fn cycles_follow_what_is_left() {
    let plate = rounded_box(DVec3::new(1.0, 0.27, 1.0), 0.02, 3);
    let options = |most_cycles| DiffusionOptions { cycles: 2, most_cycles, residual: true, warm: false };
    let of = |most_cycles| Lone::with(plate.clone(), 64, (15.0, 0.01), (options(most_cycles), false));
    let two = of(2);
    let mut right = everywhere(&two, 15.0);
    let count = two.grid.cells as usize;
    for (index, load) in right.iter_mut().enumerate() {
        *load *= if (index / count) % count < count / 2 - 6 { 1.0 } else { 0.0 };
    }
    let with = |least| DiffusionOptions { cycles: least, ..options(least) };
    let fixed = |least| Lone::with(plate.clone(), 64, (15.0, 0.01), (with(least), false));
    let solved = |lone: &Lone| {
        let found = lone.solve(&right);
        (lone.residual(&right, &found).0, found)
    };
    let needed = (2..8).map(|least| (least, solved(&fixed(least)))).find(|(_, (left, _))| *left < 1e-3);
    let (needed, (left, expected)) = needed.expect("a few are enough");
    let (after, found) = solved(&of(8));
    println!(
        "residual after 2 cycles {:.1e}, after {needed} {left:.1e}, after as many as follow {after:.1e}",
        solved(&two).0
    );
    let largest = expected.iter().copied().fold(0.0, f64::max);
    let apart = expected.iter().zip(&found).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    assert!(needed > 2 && apart < 1e-5 * largest, "{needed} cycles are needed: {apart} of {largest}");
    // Where two are enough, none follows.
    let ball = |most_cycles| Lone::with(sphere(1.0, 64), 16, (8.0, 0.5), (options(most_cycles), false));
    let all = everywhere(&ball(2), 8.0);
    let [two, eight] = [2, 8].map(|most| ball(most).solve(&all));
    let (left, _) = ball(2).residual(&all, &two);
    let apart = two.iter().zip(&eight).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    assert!(left < 1e-3 && apart < 1e-6, "{left}: {apart}");
}

/// Why the solver is multigrid: conjugate gradients need more iterations the finer the grid is, each of which is at
/// least the work of a sweep; a cycle is 8 sweeps of the finest grid.
#[test]
fn conjugate_gradients_need_more_than_multigrid_and_ever_more() {
    let mut needed = Vec::new();
    for cells in [16, 32, 64] {
        let lone = Lone::of(sphere(1.0, 64), cells, (8.0, 0.001), 2);
        let right = everywhere(&lone, 8.0);
        let (multigrid, _) = lone.residual(&right, &lone.solve(&right));
        let iterations = conjugate_gradients(&lone, &right, multigrid);
        println!("{cells} cells: two cycles leave {multigrid:.1e}, for which conjugate gradients take {iterations}");
        needed.push(iterations);
    }
    assert!(needed[2] > 2 * 8 && needed[2] as f64 > 1.5 * needed[1] as f64, "{needed:?}");
}

#[test]
fn light_goes_both_ways_alike_and_never_grows_with_absorption() {
    let lone = Lone::of(sphere(1.0, 64), 32, (6.0, 0.01), 14);
    let filled: Vec<usize> =
        (0..).zip(lone.volumes()).filter(|(_, volume)| *volume > 0.0).map(|(index, _)| index).collect();
    let voxel = |share: f64| filled[(share * filled.len() as f64) as usize];
    let from = |source: usize| {
        let mut right = vec![0.0; lone.grid.count()];
        right[source] = 1.0;
        lone.solve(&right)
    };
    for (one, other) in [(voxel(0.01), voxel(0.6)), (voxel(0.3), voxel(0.99)), (voxel(0.5), voxel(0.51))] {
        let (there, back) = (from(one)[other], from(other)[one]);
        assert!((there / back - 1.0).abs() < 1e-3 && there > 0.0, "{one}, {other}: {there} {back}");
    }
    let darker = Lone::of(sphere(1.0, 64), 32, (6.0, 0.02), 14);
    // The same light: what begins at a rate of 1.
    let [clear, dark] = [&lone, &darker].map(|lone| lone.solve(&everywhere(lone, 6.0)));
    assert!(filled.iter().all(|index| dark[*index] < clear[*index]));
}

#[test]
fn islands_and_matter_that_loses_nothing_have_finite_light() {
    // Two balls, one of which a voxel swallows.
    let mut mesh = sphere(1.0, 32);
    mesh.append(&sphere(0.03, 8).placed(DQuat::IDENTITY, 1.5 * DVec3::X));
    let lone = Lone::of(mesh, 32, (1e-3, 0.0), 8);
    let fluence = lone.solve(&everywhere(&lone, 1e-3));
    assert!(fluence.iter().all(|value| value.is_finite() && *value >= 0.0));
    let lone = Lone::of(sphere(1.0, 32), 16, (1e6, 0.0), 8);
    let fluence = lone.solve(&everywhere(&lone, 1e6));
    assert!(fluence.iter().all(|value| value.is_finite() && *value >= 0.0));
    assert!(fluence.iter().any(|value| *value > 0.0));
}

#[test]
fn a_warm_start_goes_on_where_the_last_frame_ended() {
    let residuals = [false, true].map(|warm| {
        let lone = Lone::with(
            sphere(1.0, 64),
            32,
            (8.0, 0.01),
            (DiffusionOptions { cycles: 2, most_cycles: 2, warm, residual: true }, false),
        );
        let right = everywhere(&lone, 8.0);
        [(); 3].map(|()| lone.residual(&right, &lone.solve(&right)).0)
    });
    let [cold, warm] = residuals;
    assert!(cold[0] == cold[2], "{cold:?}");
    assert!(warm[2] < 0.2 * warm[1] && warm[1] < 0.2 * warm[0], "{warm:?}");
}

#[test]
fn nothing_that_a_material_may_hold_breaks_the_equations() {
    for matter in [(1e18, 0.0), (1e18, 1.0), (1e18, 0.5), (1e-30, 0.5), (0.0, 0.0)] {
        let lone = Lone::of(sphere(1.0, 32), 16, matter, 4);
        let fluence = lone.solve(&everywhere(&lone, 1.0));
        assert!(fluence.iter().all(|value| value.is_finite() && *value >= 0.0), "{matter:?}");
    }
}

/// Light from one cell of thin matter: diffusion's conductances would let more of it flow than there is. The device solves the
/// equations that the mirror limits, in each channel by its own extinction, and what is put in leaves or is absorbed.
#[test]
fn the_flux_limiter_keeps_the_flux_below_the_fluence() {
    let extinctions = Vec3::new(0.5, 2.0, 8.0);
    let mut before = f64::INFINITY;
    for cycles in [2, 4, 8, 16] {
        let medium = Medium::isotropic(0.99 * extinctions, 0.01 * extinctions);
        let options = DiffusionOptions { cycles, most_cycles: cycles, residual: true, ..DiffusionOptions::default() };
        let lone = Lone::of_medium(sphere(1.0, 64), 32, medium, options, true);
        let mut right = vec![0.0; lone.grid.count()];
        let full = (0..).zip(lone.volumes()).filter(|(_, volume)| *volume == 1.0).map(|(index, _)| index);
        right[full.into_iter().nth(5_000).expect("a cell")] = 1.0;
        let solved = lone.solve_all(&right);
        let told = lone.levels.residual(&lone.executor).expect("read").expect("asked for");
        let mut left = [0.0; 3];
        for channel in 0..3 {
            let extinction = extinctions[channel] * lone.grid.spacing;
            let (faces, slowest) = lone.limited(extinction, &solved[channel]);
            let (residual, unaccounted) = lone.residual_of(&faces, channel, &right, &solved[channel]);
            println!(
                "extinction {}, {cycles} cycles: residual {residual:.1e}, unaccounted {unaccounted:.1e}, factors from {slowest:.3}",
                extinctions[channel]
            );
            assert!(
                (told[channel] - residual).abs() < 1e-3 * residual + 2e-5,
                "{channel}, {cycles}: {residual} {told:?}"
            );
            // The source's next cells have half of its light or less.
            assert!(slowest < [0.2, 0.5, 0.9][channel] && unaccounted < 1e-2, "{channel}: {slowest} {unaccounted}");
            left[channel] = residual;
        }
        assert!(left[0] < before, "{cycles}: {left:?} {before}");
        before = left[0];
        if cycles == 16 {
            assert!(left[0] < 5e-3 && left[1] < 1e-5 && left[2] < 1e-5, "{left:?}");
        }
    }
}

/// A frame from no light at all does not know of the one before, whose limited conductances the coarser grids still hold.
#[test]
fn a_limited_frame_does_not_depend_on_the_one_before() {
    let options = DiffusionOptions::default();
    let fresh = || Lone::with(sphere(1.0, 64), 32, (0.5, 0.01), (options, true));
    let lone = fresh();
    let all = everywhere(&lone, 0.5);
    let mut one = vec![0.0; all.len()];
    one[(0..).zip(&all).find(|(_, load)| **load > 0.0).map(|(index, _)| index).expect("a cell")] = 1.0;
    lone.solve(&one);
    // What the device adds up in another order.
    let furthest = lone.solve(&all).iter().zip(fresh().solve(&all)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(furthest < 1e-6, "{furthest}");
}
