//! The cloth: soft folds, and a furrow in which the ring stands.

use glam::{DVec2, DVec3, Vec3};

use crate::Mesh;
use crate::surfaces::grid;

/// Half the cloth's side, and squares along it.
const HALF: f64 = 56.0;
const SQUARES: u32 = 180;
/// Folds: direction across in radians from x towards z, distance of the ridge from the middle, height, half width, and how
/// much it bends.
const FOLDS: [[f64; 5]; 9] = [
    [1.20, -9.5, 1.7, 2.6, 0.020],
    [0.92, -16.5, 2.4, 3.4, -0.012],
    [1.42, -24.0, 3.0, 4.0, 0.008],
    [1.05, -34.0, 3.6, 5.0, -0.006],
    [0.10, -12.5, 1.3, 2.4, -0.022],
    [0.30, 13.0, 1.5, 2.7, 0.018],
    [1.90, 10.0, 1.2, 2.3, -0.025],
    [0.62, 18.0, 1.8, 3.0, 0.012],
    [2.30, -20.0, 2.0, 3.5, 0.015],
];
/// The rolls beside the furrow: distance from its middle, half width, height and half length.
const ROLLS: [f64; 4] = [2.3, 0.95, 1.7, 7.0];

/// Height of its underside.
const UNDER: f64 = -2.0;

/// Returns the cloth with a furrow along the ring's plane, which is turned by `turn` about the vertical.
pub(super) fn mesh(turn: f64) -> Mesh {
    let mesh = grid([SQUARES, SQUARES], |uv| {
        let place = HALF * DVec2::new(2.0 * uv.x - 1.0, 2.0 * uv.y - 1.0);
        let slope = |step: DVec2| (height(place + step, turn) - height(place - step, turn)) / 2e-3;
        let normal = DVec3::new(-slope(DVec2::new(1e-3, 0.0)), 1.0, -slope(DVec2::new(0.0, 1e-3)));
        (DVec3::new(place.x, height(place, turn), place.y), normal.normalize())
    });
    closed(mesh.without_uvs())
}

/// Adds sides and an underside, so that the cloth is a body.
fn closed(mut top: Mesh) -> Mesh {
    let row = SQUARES + 1;
    // Around, as seen from above against the clock: down the left edge, along the front, up the right, back.
    let sides = [(0, row), (SQUARES * row, 1), (row * row - 1, row.wrapping_neg()), (SQUARES, 1_u32.wrapping_neg())];
    for (first, step) in sides {
        let edge = |number: u32| top.positions[first.wrapping_add(number.wrapping_mul(step)) as usize];
        let corners: Vec<Vec3> = (0..=SQUARES).map(edge).collect();
        let outwards = (corners[SQUARES as usize] - corners[0]).with_y(0.0).cross(Vec3::Y).normalize();
        for pair in corners.windows(2) {
            let [left, right] = [pair[0], pair[1]];
            let [below_left, below_right] = [left, right].map(|corner| corner.with_y(UNDER as f32));
            let middle = Vec3::new(0.0, UNDER as f32, 0.0);
            let mut add = |corners: [Vec3; 3], normal: Vec3| {
                top.indices.extend((0..3).map(|corner| top.positions.len() as u32 + corner));
                top.positions.extend(corners);
                top.normals.extend([normal; 3]);
            };
            add([left, below_left, right], outwards);
            add([right, below_left, below_right], outwards);
            add([middle, below_right, below_left], Vec3::NEG_Y);
        }
    }
    top
}

/// Height at x and z.
fn height(place: DVec2, turn: f64) -> f64 {
    let fold = |[across, distance, height, width, bend]: [f64; 5]| {
        let axis = DVec2::from_angle(across);
        let (at, along) = (place.dot(axis), place.dot(axis.perp()));
        height * (-((at - distance - bend * along * along) / width).powi(2)).exp()
    };
    // The ring's plane holds (cos turn, -sin turn).
    let (along, across) = {
        let plane = DVec2::new(turn.cos(), -turn.sin());
        (place.dot(plane), place.dot(plane.perp()))
    };
    let [distance, width, rise, length] = ROLLS;
    let roll =
        (-((across.abs() - distance) / width).powi(2)).exp() + (-((across.abs() + distance) / width).powi(2)).exp();
    let ripple = 0.10 * (0.55 * place.x + 0.21 * place.y).sin() + 0.08 * (0.31 * place.x - 0.47 * place.y + 1.0).sin();
    let near = (-(along / length).powi(2)).exp();
    let folds: f64 = FOLDS.into_iter().map(fold).sum();
    folds + ripple * (1.0 - near) + rise * roll * near
}
