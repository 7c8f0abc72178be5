//! The meshes of the scene `vitrine`, placed on its table. Lengths are in millimetres; the top of
//! the table is at 0.

use crate::{candle, figure};
use glam::{DQuat, DVec3};
use lapidary_scene::cuts::{BrilliantParameters, round_brilliant};
use lapidary_scene::surfaces::{rounded_box, sphere};
use lapidary_scene::{Averaging, Bounds, Mesh, Scene, SceneError};

/// Girdle radii of the stones.
const DIAMOND: f32 = 17.0;
const RUBY: f32 = 13.5;
/// Scale of the chain relative to the built-in one: a link is 18 mm wide.
const CHAIN: f32 = 18.0;
/// Gap between the table and the bodies on it, so that no two surfaces coincide.
const GAP: f64 = 0.02;

/// Radius of the jade ball.
pub(crate) const BALL: f64 = 9.5;
/// Half width of the stand's rods, where its post stands, how high its arm is, and where the chain hangs.
const ROD: f64 = 1.6;
const POST: DVec3 = DVec3::new(88.0, 0.0, -30.0);
const ARM: f64 = 138.5;
/// Radius of the eye at the hook's end.
const EYE: f64 = 2.0;
const HOOK: DVec3 = DVec3::new(62.0, 131.0, 6.0);

/// Returns the table, the diamond, the ruby, the candle, the figure, the chain, the ball and the stand's four parts.
pub(crate) fn meshes() -> Result<Vec<Mesh>, SceneError> {
    let (half, rounding) = (DVec3::new(150.0, 7.0, 100.0), 2.5);
    let table = rounded_box(half, rounding, 2).placed(DQuat::IDENTITY, DVec3::NEG_Y * half.y);
    let brilliant = round_brilliant(&BrilliantParameters::TOLKOWSKY)?.to_mesh(Averaging::default());
    let chain = Scene::named("prism_chain")?.objects.into_iter().map(|object| object.mesh.scaled(CHAIN));
    let chain = chain.map(|mesh| mesh.placed(DQuat::IDENTITY, HOOK));
    let bodies = [
        table,
        standing(&brilliant.scaled(DIAMOND), lying(18.0), [-14.0, 42.0]),
        standing(&brilliant.scaled(RUBY), lying(-38.0), [37.0, 36.0]),
        standing(&plain(candle::mesh()), turned(0.0), [-54.0, 12.0]),
        standing(&figure::fine_mesh(), turned(8.0), [10.0, -28.0]),
    ];
    let ball = standing(&sphere(BALL, 64), turned(0.0), [64.0, 66.0]);
    Ok(bodies.into_iter().chain(chain).chain([ball]).chain(stand()).collect())
}

/// Returns the stand's foot, its post, its arm, and the hook from which the chain hangs. Each is a body of its own, since
/// stones see bodies by their bounds, and bounds around all of them would be mostly air.
fn stand() -> [Mesh; 4] {
    // Upright, or level with two faces level.
    let rod = |from: DVec3, to: DVec3| {
        let way = to - from;
        let half = 0.5 * way.length();
        let (half, turn) = if way.x == 0.0 && way.z == 0.0 {
            (DVec3::new(ROD, half, ROD), DQuat::IDENTITY)
        } else {
            (DVec3::new(ROD, ROD, half), DQuat::from_rotation_y(way.x.atan2(way.z)))
        };
        plain(rounded_box(half, 0.3 * ROD, 3)).placed(turn, 0.5 * (from + to))
    };
    let foot = DVec3::new(11.0, 2.0, 11.0);
    let (post, over, below) = (POST.with_y(ARM), HOOK.with_y(ARM), ARM - ROD - GAP);
    let along = (post - over).normalize();
    // A hair above the uppermost link.
    let eye = HOOK + (EYE + 5.0 * GAP) * DVec3::Y;
    let mut hook = rod(HOOK.with_y(below), eye);
    hook.append(&plain(sphere(EYE, 32)).placed(DQuat::IDENTITY, eye));
    [
        standing(&plain(rounded_box(foot, 1.5, 4)), turned(0.0), [POST.x, POST.z]),
        rod(POST + 2.0 * (foot.y + GAP) * DVec3::Y, POST.with_y(below)),
        // It reaches over the post and over the hook.
        rod(post + 2.0 * ROD * along, over - 2.0 * ROD * along),
        hook,
    ]
}

/// Returns the mesh without texture coordinates: nothing on it is blurred.
fn plain(mesh: Mesh) -> Mesh {
    Mesh { uvs: Vec::new(), ..mesh }
}

/// Rotation about the vertical, in degrees from +z towards +x.
fn turned(azimuth: f64) -> DQuat {
    DQuat::from_rotation_y(azimuth.to_radians())
}

/// Rotation of a brilliant that rests on one of its pavilion's main facets, as a loose stone does,
/// with its table facing this azimuth.
fn lying(azimuth: f64) -> DQuat {
    // The first of these facets is the one towards +x.
    let leaning = DQuat::from_rotation_z(-BrilliantParameters::TOLKOWSKY.pavilion_degrees.to_radians());
    turned(azimuth - 90.0) * leaning
}

/// Returns the mesh rotated, and moved to this x and z with its lowest point just above the table.
fn standing(mesh: &Mesh, rotation: DQuat, [x, z]: [f64; 2]) -> Mesh {
    let lowest = Bounds::of(mesh.placed(rotation, DVec3::ZERO).positions).min.y;
    mesh.placed(rotation, DVec3::new(x, GAP - f64::from(lowest), z))
}
