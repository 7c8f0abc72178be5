//! Ground truth in f64: the hash in 64 bits, the gradient from a table, the noise as a sum over
//! eight corners with products of weights, each weight from the integral of 30 t² (1 - t)².

use glam::{DVec3, IVec3};

// The module's constants, repeated: a mistake in the module must not carry over to the truth.
const FARTHEST: f64 = 4_194_304.0;
const NARROWEST: f64 = 1.0 / 1024.0;

/// A cell of the noise and a position in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VeinsCell {
    /// Corner of the cell at the lower coordinates.
    pub corner: IVec3,
    /// Position relative to that corner, in [0, 1].
    pub offset: DVec3,
}

/// Parameters of a stone's veins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VeinsPattern {
    /// Number of cells of the first octave per unit of length.
    pub frequency: f64,
    /// Value of the noise at which a vein's density has fallen halfway to `least`.
    pub width: f64,
    /// Density between the veins.
    pub least: f64,
    /// Density in the middle of a vein.
    pub greatest: f64,
    /// Number of octaves, 0 to 8; more count as 8.
    pub octaves: u32,
    /// Seed; different seeds give different veins.
    pub seed: u32,
}

/// Divides with a remainder that is not negative.
pub fn cell(position: DVec3) -> VeinsCell {
    let parts = position.to_array().map(|x| {
        let x = x.clamp(-FARTHEST, FARTHEST);
        (x.div_euclid(1.0) as i32, x.rem_euclid(1.0))
    });
    VeinsCell {
        corner: IVec3::from_array(parts.map(|part| part.0)),
        offset: DVec3::from_array(parts.map(|part| part.1)),
    }
}

/// Truncates towards 0, which is a different function.
pub fn cell_naive(position: DVec3) -> VeinsCell {
    VeinsCell { corner: position.trunc().as_ivec3(), offset: position - position.trunc() }
}

/// Computes the hash in 64 bits, so that nothing overflows.
pub fn hash(corner: IVec3, seed: u32) -> u32 {
    let rest = |value: u64| value % (1 << 32);
    let corner = corner.to_array().map(|part| i64::from(part).rem_euclid(1 << 32) as u64);
    let mut words = [corner[0], corner[1], corner[2], seed.into()].map(|word| rest(word * 1_664_525 + 1_013_904_223));
    for (to, a, b) in [(0, 1, 3), (1, 2, 0), (2, 0, 1), (3, 1, 2)] {
        words[to] = rest(words[to] + rest(words[a] * words[b]));
    }
    let [x, y, _, w] = words.map(|word| word ^ (word / (1 << 16)));
    rest(x + rest(y * w)) as u32
}

/// Looks up the signs by the quarter of the range that the bits lie in, and the axis by their
/// remainder modulo 3.
pub fn gradient(bits: u32) -> DVec3 {
    const SIGNS: [[f64; 2]; 4] = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let mut parts = SIGNS[bits as usize / (1 << 30)].to_vec();
    parts.insert(bits as usize - bits as usize / 3 * 3, 0.0);
    DVec3::new(parts[0], parts[1], parts[2])
}

/// Evaluates the gradient's plane through the corner.
pub fn corner(cell: VeinsCell, corner: IVec3, seed: u32) -> f64 {
    let gradient = gradient(hash(cell.corner + corner, seed));
    (0..3).map(|axis| gradient[axis] * (cell.offset[axis] - f64::from(corner[axis]))).sum()
}

/// Returns the integral of 30 t² (1 - t)² from 0 to t.
fn weight(t: f64) -> f64 {
    10.0 * t.powi(3) - 15.0 * t.powi(4) + 6.0 * t.powi(5)
}

/// Sums over the eight corners.
pub fn noise(position: DVec3, seed: u32) -> f64 {
    let cell = cell(position);
    let part = |number: i32| {
        let vertex = IVec3::new(number & 1, number >> 1 & 1, number >> 2);
        let weights = (0..3).map(|axis| {
            let towards = weight(cell.offset[axis]);
            if vertex[axis] == 1 { towards } else { 1.0 - towards }
        });
        weights.product::<f64>() * corner(cell, vertex, seed)
    };
    (0..8).map(part).sum()
}

/// Adds half of the sum of the other octaves to the first octave.
pub fn fractal(position: DVec3, octaves: u32, seed: u32) -> f64 {
    match octaves.min(8) {
        0 => 0.0,
        octaves => noise(position, seed) + 0.5 * fractal(2.0 * position, octaves - 1, seed.wrapping_add(1)),
    }
}

/// Returns the squared cosine of the angle whose tangent is value / width.
pub fn fold(value: f64, width: f64) -> f64 {
    (value / width.max(NARROWEST)).atan().cos().powi(2)
}

/// Computes the straight line, which is a different function.
pub fn fold_naive(value: f64, width: f64) -> f64 {
    (width - value.abs() / 2.0) / width
}

/// Interpolates from `least` to `greatest` by the share of vein.
pub fn density(position: DVec3, pattern: VeinsPattern) -> f64 {
    let share = fold(fractal(position * pattern.frequency, pattern.octaves, pattern.seed), pattern.width);
    pattern.least + (pattern.greatest - pattern.least) * share
}
