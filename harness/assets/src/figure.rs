//! A statue: a winged figure on a plinth, raising a wreath. Feathers, arms and wreath are thin
//! enough for light to pass through; the robe and the plinth are not.
//!
//! Lengths are in millimetres; y is up, the plinth stands at 0, and the figure looks towards +z.

use super::implicit::{Grid, difference, ellipsoid, intersection, limb, surface, union};
use glam::{DQuat, DVec2, DVec3, dvec2, dvec3};
use lapidary_scene::Mesh;

/// Returns the statue, 117 mm high.
#[must_use]
pub fn mesh() -> Mesh {
    surface(&field, &grid(1.5))
}

/// Returns the statue with a robe and a plinth that bear looking at from near.
#[must_use]
pub fn fine_mesh() -> Mesh {
    surface(&field, &grid(0.25))
}

/// Returns a grid with cells of 1.3 mm at the face, wider on the wings, and wider by the share `coarser` at the
/// plinth's foot.
fn grid(coarser: f64) -> Grid {
    let scale = |height: f64| 1.0 + coarser * (1.0 - height / 82.0).clamp(0.0, 1.0);
    let stretch = |aside: f64| 1.0 + 0.25 * ((aside - 9.0) / 8.0).clamp(0.0, 1.0);
    Grid::graded(dvec2(0.0, -1.0), dvec2(48.0, 20.0), [-4.0, 122.0], 1.28, scale, stretch)
}

/// Signed field of the statue: negative inside, positive outside.
fn field(point: DVec3) -> f64 {
    let body = union(robe(point), torso(point), 3.0);
    let body = union(body, arms(point), 2.2);
    let body = union(body, head(point), 1.5);
    let body = union(body, wings(point), 1.5);
    let body = union(body, wreath(point), 0.6);
    union(body, plinth(point), 0.8)
}

/// A disc with a rounded rim, about the y axis.
fn disc(point: DVec3, radius: f64, [low, high]: [f64; 2]) -> f64 {
    let across = dvec2(point.x, point.z).length() - radius;
    intersection(across, (point.y - 0.5 * (low + high)).abs() - 0.5 * (high - low), 2.4)
}

fn plinth(point: DVec3) -> f64 {
    let foot = disc(point, 19.5, [0.0, 4.0]);
    let drum = disc(point, 16.5, [2.0, 11.0]);
    let rim = disc(point, 18.3, [9.0, 13.0]);
    union(union(foot, drum, 2.0), rim, 2.0)
}

/// Interpolates smoothly between the `[height, value]` pairs of `table`.
fn profile(height: f64, table: &[[f64; 2]]) -> f64 {
    let last = table.len() - 1;
    let above = table.iter().position(|[from, _]| height < *from).unwrap_or(last).max(1);
    let [[low, first], [high, second]] = [table[above - 1], table[above]];
    let share = ((height - low) / (high - low)).clamp(0.0, 1.0);
    first + (second - first) * share * share * (3.0 - 2.0 * share)
}

/// A long robe that falls in folds over a bent knee.
fn robe(point: DVec3) -> f64 {
    let sway = profile(point.y, &[[10.0, 0.0], [52.0, 1.3], [66.0, 0.0]]);
    let across = dvec2(point.x - sway, 1.25 * (point.z + 0.5));
    let (radius, azimuth) = (across.length(), across.x.atan2(across.y));
    let wide = profile(point.y, &[[10.0, 15.2], [16.0, 13.2], [34.0, 10.8], [54.0, 9.3], [66.0, 6.2]]);
    let deep = profile(point.y, &[[10.0, 1.5], [40.0, 1.0], [62.0, 0.05]]);
    // The folds wander a little on their way down.
    let turn = 0.5 * (0.07 * point.y).sin();
    let folds = (10.0 * azimuth + 3.0 * turn).cos() + 0.55 * (6.0 * azimuth - 2.0 * turn + 1.0).sin();
    let cloth = 0.8 * (radius - wide - deep * folds);
    let skirt = intersection(cloth, (point.y - 37.5).abs() - 27.5, 2.0);
    let thigh = limb(point, dvec3(4.2, 56.0, 1.0), dvec3(5.0, 37.0, 7.0), [5.6, 4.3]);
    let shin = limb(point, dvec3(5.0, 37.0, 7.0), dvec3(5.6, 13.0, 5.4), [4.3, 4.2]);
    union(skirt, union(thigh, shin, 2.5), 4.5)
}

fn torso(point: DVec3) -> f64 {
    let sided = dvec3(point.x.abs(), point.y, point.z);
    let hips = ellipsoid(point - dvec3(0.6, 59.0, 0.0), dvec3(8.4, 6.2, 6.6));
    let waist = limb(point, dvec3(0.4, 60.0, 0.0), dvec3(0.0, 72.0, 0.0), [5.4, 5.2]);
    let chest = ellipsoid(point - dvec3(0.0, 74.0, 0.0), dvec3(7.4, 9.0, 5.4));
    let shoulders = limb(sided, dvec3(0.0, 82.0, -0.6), dvec3(8.4, 81.0, -0.6), [3.2, 3.0]);
    let breasts = ellipsoid(sided - dvec3(3.5, 75.8, 3.6), dvec3(3.0, 3.0, 2.9));
    let trunk = union(union(union(hips, waist, 4.0), chest, 4.0), shoulders, 3.5);
    let trunk = union(trunk, breasts, 1.6);
    // A sash from one shoulder to the opposite hip, and a belt.
    let across = (point - dvec3(0.0, 72.0, 0.0)).dot(dvec3(0.62, 0.78, 0.0));
    let pleats = 0.25 * (2.4 * across).cos();
    let sash = intersection(trunk - 0.9 - pleats, across.abs() - 3.4, 1.2);
    let belt = intersection(trunk - 0.9, (point.y - 64.5).abs() - 1.0, 0.8);
    let neck = limb(point, dvec3(0.0, 83.0, -0.8), dvec3(0.3, 91.0, 0.4), [3.5, 3.0]);
    union(union(union(trunk, sash, 0.8), belt, 0.8), neck, 2.5)
}

/// One arm raised with the wreath, the other with its hand on the hip.
fn arms(point: DVec3) -> f64 {
    let chain = |[shoulder, elbow, wrist]: [DVec3; 3], hand: f64| {
        let upper = limb(point, shoulder, elbow, [3.0, 2.2]);
        let lower = limb(point, elbow, wrist, [2.3, 1.5]);
        let calf = ellipsoid(point - elbow.lerp(wrist, 0.25), DVec3::splat(2.4));
        union(union(union(upper, lower, 1.0), calf, 1.5), hand, 1.2)
    };
    let fingers = |knuckles: DVec3, tips: DVec3, aside: DVec3| {
        let finger = |place: f64| {
            let shift = place * aside;
            limb(point, knuckles + shift, tips + 0.8 * shift, [1.0, 0.9])
        };
        [-1.0, 0.0, 1.0].map(finger).into_iter().fold(f64::INFINITY, |all, one| union(all, one, 0.9))
    };
    let palm = ellipsoid(point - dvec3(-21.4, 104.6, 5.9), dvec3(1.5, 2.4, 1.9));
    let grip = fingers(dvec3(-20.4, 106.4, 5.6), dvec3(-18.2, 106.9, 6.6), dvec3(0.1, 1.1, 1.0));
    let thumb = limb(point, dvec3(-20.6, 104.6, 7.2), dvec3(-18.6, 105.4, 7.9), [0.95, 0.75]);
    let hand = union(union(palm, grip, 0.8), thumb, 0.8);
    let raised = chain([dvec3(-9.0, 81.0, -0.6), dvec3(-20.5, 88.5, 2.5), dvec3(-21.4, 102.0, 5.8)], hand);
    let palm = ellipsoid(point - dvec3(9.9, 60.6, 6.0), dvec3(1.7, 1.8, 1.7));
    let laid = fingers(dvec3(8.9, 59.6, 6.6), dvec3(5.4, 58.2, 7.4), dvec3(0.2, 1.1, 0.0));
    let hand = union(palm, laid, 1.2);
    let hip = chain([dvec3(9.0, 81.0, -0.6), dvec3(20.0, 70.0, -1.0), dvec3(12.0, 61.6, 5.0)], hand);
    raised.min(hip)
}

/// A ring with leaves.
fn wreath(point: DVec3) -> f64 {
    let from = point - dvec3(-15.0, 110.5, 6.4);
    let (radius, azimuth) = (from.truncate().length(), from.y.atan2(from.x));
    let swelling = 1.0 + 0.13 * (9.0 * azimuth + from.z).cos();
    dvec2(radius - 5.6, from.z).length() - 1.55 * swelling
}

fn head(point: DVec3) -> f64 {
    const SIZE: f64 = 1.22;
    // Turned a little towards the raised arm, and bowed.
    let turned = DQuat::from_rotation_y(-0.38) * DQuat::from_rotation_x(0.08) * DQuat::from_rotation_z(0.06);
    let local = turned.inverse() * (point - dvec3(0.3, 97.2, 1.4)) / SIZE;
    let sided = dvec3(local.x.abs(), local.y, local.z);
    let skull = ellipsoid(local - dvec3(0.0, 1.5, -0.8), dvec3(4.9, 5.5, 5.8));
    let jaw = ellipsoid(local - dvec3(0.0, -2.6, 1.5), dvec3(3.6, 4.7, 4.1));
    let chin = ellipsoid(local - dvec3(0.0, -6.0, 4.1), dvec3(1.6, 1.2, 1.3));
    let cheeks = ellipsoid(sided - dvec3(2.5, -1.6, 3.6), DVec3::splat(1.6));
    let face = union(union(union(skull, jaw, 2.5), chin, 1.2), cheeks, 1.2);
    let brows = limb(sided, dvec3(0.5, 1.8, 5.0), dvec3(3.2, 1.5, 3.8), [0.8, 0.7]);
    let face = union(face, brows, 1.2);
    let sockets = ellipsoid(sided - dvec3(2.0, 0.1, 5.9), dvec3(1.5, 1.0, 1.5));
    let face = difference(face, sockets, 1.2);
    let eyes = ellipsoid(sided - dvec3(1.95, 0.0, 3.9), dvec3(1.2, 0.9, 1.1));
    let face = union(face, eyes, 0.6);
    let nose = limb(local, dvec3(0.0, 1.2, 5.2), dvec3(0.0, -1.8, 6.4), [0.7, 0.95]);
    let wings = ellipsoid(sided - dvec3(0.7, -2.2, 5.8), DVec3::splat(0.8));
    let face = union(face, union(nose, wings, 0.7), 0.8);
    // Two lips: a bulge with a groove across.
    let mouth = ellipsoid(local - dvec3(0.0, -4.25, 4.8), dvec3(1.6, 1.0, 1.05));
    let parting = 0.16 * (-((local.y + 4.2) / 0.7).powi(2)).exp() * (1.0 - local.x * local.x / 3.0).max(0.0);
    let face = union(face, mouth + parting, 0.7);
    // Parted, wavy hair, drawn back into a knot.
    let strands = 0.2 * (2.1 * local.y + 1.2 * local.z + 2.5 * (0.45 * sided.x).sin()).sin();
    let hair = ellipsoid(local - dvec3(0.0, 2.0, -1.3), dvec3(5.9, 5.9, 6.3)) - strands;
    let opening = ellipsoid(local - dvec3(0.0, -2.6, 6.0), dvec3(4.6, 6.6, 6.0));
    let hair = difference(hair, opening, 1.0);
    let below = 1.4 * local.z - local.y - 5.2;
    let hair = intersection(hair, below, 1.5);
    let knot = ellipsoid(local - dvec3(0.0, 0.6, -7.4), dvec3(2.7, 2.5, 2.2)) - strands;
    union(union(face, hair, 0.8), knot, 1.0)
}

/// A feather: a strip with a rounded edge that lies flat in a plane of constant z, given by its end
/// points, half width and half depth.
fn feather(point: DVec3, [from, to]: [DVec2; 2], [half_width, half_depth]: [f64; 2]) -> f64 {
    let (way, along) = (point.truncate() - from, to - from);
    let share = (way.dot(along) / along.length_squared()).clamp(0.0, 1.0);
    let taper = 1.0 - 0.3 * share * share;
    let aside = (way.distance(share * along) - taper * (half_width - half_depth)).max(0.0);
    dvec2(aside, point.z).length() - taper * half_depth
}

/// Both wings, raised and half spread.
fn wings(point: DVec3) -> f64 {
    let (root, wrist) = (dvec2(4.8, 77.0), dvec2(20.0, 99.0));
    // Bent back from the shoulder blades outwards.
    let sided = dvec3(point.x.abs(), point.y, point.z + 5.6 + 0.2 * point.x.abs());
    let bone = feather(sided, [root, wrist], [2.5, 2.2]);
    let toward = |degrees: f64| DVec2::from_angle(degrees.to_radians());
    // From the wing's tip round to the body: start, angle in degrees and length of each feather.
    let primaries = (0..6).map(|k| {
        let k = f64::from(k);
        (wrist - dvec2(0.0, 0.4 * k), 34.0 - 20.0 * k, 24.0 - 0.6 * k)
    });
    let secondaries = (0..3).map(|k| {
        let k = f64::from(k);
        (wrist.lerp(root, 0.2 + 0.26 * k), -82.0 - 2.0 * k, 21.5 - 2.2 * k)
    });
    let fan = primaries.chain(secondaries).map(|(from, angle, length)| {
        let long = feather(sided, [from, from + length * toward(angle)], [3.4, 1.35]);
        let shifted = sided - dvec3(0.0, 0.0, 0.9);
        let covert = feather(shifted, [from, from + 0.42 * length * toward(angle - 4.0)], [3.0, 1.4]);
        union(long, covert, 1.0)
    });
    fan.fold(bone, |all, one| union(all, one, 1.2))
}

#[cfg(test)]
mod tests;
