//! Mip levels of images. Each texel of a level is the mean of what it covers of the level before: of light for colours,
//! of shares for data, of slopes for normals.

use crate::frame::level_size;
use exr::prelude::f16;
use glam::{Vec2, Vec4};
use lapidary_scene::{Encoding, Texels};
use std::ops::{Add, Mul};

/// Layers of slopes: x and y of unit normals, row by row.
pub(super) struct Layers {
    pub(super) size: [u32; 2],
    pub(super) layers: Vec<Vec<Vec2>>,
}

impl Layers {
    /// Returns the number of levels, and their bytes as half floats, layer by layer, level by level.
    pub(super) fn levels(self) -> (u32, Vec<u8>) {
        let Self { size, mut layers } = self;
        let count = count(size);
        let mut bytes = Vec::new();
        for level in 0..count {
            if level > 0 {
                let size = level_size(size, level - 1);
                for layer in &mut layers {
                    *layer = halved(size, |place| layer[place]);
                }
            }
            let parts = layers.iter().flatten().flat_map(|slopes| slopes.to_array());
            bytes.extend(parts.flat_map(|part| f16::from_f32(part).to_le_bytes()));
        }
        (count, bytes)
    }
}

/// Returns the number of an image's levels, and their texels.
pub(super) fn of_image(texels: &Texels, encoding: Encoding) -> (u32, Vec<u8>) {
    let size = [texels.width(), texels.height()];
    let count = count(size);
    // All further levels take a third of the first.
    let mut bytes = Vec::with_capacity(texels.bytes().len() / 3 * 4 + 64);
    bytes.extend_from_slice(texels.bytes());
    let mut level: Vec<Vec4> = Vec::new();
    for next in 1..count {
        let (before, larger) = (level_size(size, next - 1), std::mem::take(&mut level));
        level = if next == 1 {
            halved(before, |place| encoding.decoded(std::array::from_fn(|channel| texels.bytes()[4 * place + channel])))
        } else {
            halved(before, |place| larger[place])
        };
        bytes.extend(level.iter().flat_map(|texel| encoding.encoded(*texel)));
    }
    (count, bytes)
}

/// Returns the levels of an image of linear texels, down to a single one.
pub(crate) fn of_linear(size: [u32; 2], texels: Vec<Vec4>) -> Vec<Vec<Vec4>> {
    let mut levels = vec![texels];
    for level in 1..count(size) {
        let before = &levels[level as usize - 1];
        let next = halved(level_size(size, level - 1), |place| before[place]);
        levels.push(next);
    }
    levels
}

/// Returns the number of levels down to a single texel.
fn count(size: [u32; 2]) -> u32 {
    size.into_iter().max().unwrap_or(1).max(1).ilog2() + 1
}

/// Returns the next level of an image of this size, given as its texel at each place.
fn halved<T>(size: [u32; 2], texel: impl Fn(usize) -> T) -> Vec<T>
where
    T: Copy + Default + Add<Output = T> + Mul<f32, Output = T>,
{
    let [columns, rows] = size.map(covered);
    let mut made = Vec::with_capacity(columns.len() * rows.len());
    for row in &rows {
        for column in &columns {
            let mut sum = T::default();
            for (y, high) in row {
                for (x, wide) in column {
                    sum = sum + texel(y * size[0] as usize + x) * (high * wide);
                }
            }
            made.push(sum);
        }
    }
    made
}

/// Returns for each texel of the next level which texels of a row it covers, three at most, and their shares.
fn covered(side: u32) -> Vec<[(usize, f32); 3]> {
    let next = level_size([side; 2], 1)[0];
    let length = f64::from(side) / f64::from(next);
    let texel = |place: u32| {
        let [from, to] = [place, place + 1].map(|edge| f64::from(edge) * length);
        std::array::from_fn(|step| {
            let start = from.floor() + step as f64;
            let share = (to.min(start + 1.0) - from.max(start)).max(0.0) / length;
            ((start as usize).min(side as usize - 1), share as f32)
        })
    };
    (0..next).map(texel).collect()
}

#[cfg(test)]
mod tests;
