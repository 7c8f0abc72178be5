//! Normals of an image, and their blur by how far light of each colour evens out slopes.

use super::levels::Layers;
use glam::{Vec2, Vec3, Vec3Swizzles};
use lapidary_scene::{Mesh, Texels, Texture, Wrap};

/// Longest side of the normals' layers in texels. Of larger images each layer holds every second texel, or fewer:
/// they would take a gigabyte.
const LARGEST_NORMALS: u32 = 2048;
/// Widest blur of the normals, as a standard deviation in texels.
const WIDEST_BLUR: f32 = 16.0;

/// Unit normals of an image, row by row.
pub(super) struct Normals {
    size: [u32; 2],
    normals: Vec<Vec3>,
    /// Texels of the image along a side of one of these.
    step: u32,
}

impl Normals {
    /// Returns an image's normals, with their slopes scaled.
    pub(super) fn of(texture: &Texture, scale: f32) -> Self {
        let texels: &Texels = &texture.texels;
        let longest = texels.width().max(texels.height());
        let step = longest.div_ceil(LARGEST_NORMALS);
        let size = [texels.width(), texels.height()].map(|side| side.div_ceil(step));
        let normal = |row: u32, column: u32| {
            let texel = texture.encoding.decoded(texels.at(column * step, row * step));
            let tilt = (2.0 * texel.truncate() - 1.0) * Vec3::new(scale, scale, 1.0);
            tilt.try_normalize().unwrap_or(Vec3::Z)
        };
        let normals = (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| (row, column)));
        let normals = normals.map(|(row, column)| normal(row, column)).collect();
        Self { size, normals, step }
    }

    /// Returns the size of the image, and each normal's x and y.
    pub(super) fn slopes(&self) -> ([u32; 2], Vec<Vec2>) {
        (self.size, self.normals.iter().map(|normal| normal.xy()).collect())
    }

    /// Returns the normals as they are, and blurred with a Gaussian of each of these widths in texels of the image.
    pub(super) fn layers(&self, wrap: [Wrap; 2], widths: Vec3) -> Layers {
        let blurred = widths.to_array().map(|width| self.blurred(wrap, width / self.step as f32));
        let layers = std::iter::once(&self.normals).chain(&blurred);
        Layers {
            size: self.size,
            layers: layers.map(|layer| layer.iter().map(|normal| normal.xy()).collect()).collect(),
        }
    }

    /// Returns the directions of the means by a Gaussian of this width.
    fn blurred(&self, [along, down]: [Wrap; 2], width: f32) -> Vec<Vec3> {
        let width = if width.is_finite() { width.min(WIDEST_BLUR) } else { 0.0 };
        let reach = (3.0 * width).ceil() as i64;
        if reach == 0 {
            return self.normals.clone();
        }
        let weight = |step: i64| (-0.5 * (step as f32 / width).powi(2)).exp();
        let weights: Vec<f32> = (-reach..=reach).map(weight).collect();
        let whole: f32 = weights.iter().sum();
        let weights: Vec<f32> = weights.into_iter().map(|weight| weight / whole).collect();
        let [width, height] = self.size.map(i64::from);
        let places = |count: i64, wrap: Wrap| -> Vec<usize> {
            (-reach..count + reach).map(|place| wrap.texel(place, count) as usize).collect()
        };
        let (columns, rows) = (places(width, along), places(height, down));
        let place = |row: usize, column: usize| row * width as usize + column;
        let mut once = Vec::with_capacity(self.normals.len());
        for row in 0..height as usize {
            for column in 0..width as usize {
                let beside = &columns[column..=column + 2 * reach as usize];
                once.push(
                    weights
                        .iter()
                        .zip(beside)
                        .map(|(weight, near_column)| *weight * self.normals[place(row, *near_column)])
                        .sum::<Vec3>(),
                );
            }
        }
        let mut twice = Vec::with_capacity(self.normals.len());
        for row in 0..height as usize {
            let beside = &rows[row..=row + 2 * reach as usize];
            for column in 0..width as usize {
                let mean: Vec3 =
                    weights.iter().zip(beside).map(|(weight, near_row)| *weight * once[place(*near_row, column)]).sum();
                twice.push(mean.try_normalize().unwrap_or(Vec3::Z));
            }
        }
        twice
    }
}

/// Returns the length of a texel's side on the body: the root of the mean area. 0 where the mesh has no area; infinite
/// where the coordinates have none.
pub(super) fn texel_length(mesh: &Mesh, texture: &Texture) -> f32 {
    let transform = texture.transform.affine();
    let size = Vec2::new(texture.texels.width() as f32, texture.texels.height() as f32);
    let texels = mesh.indices.chunks_exact(3).map(|corners| {
        let place = |corner: usize| size * transform.transform_point2(mesh.uvs[corners[corner] as usize]);
        let [a, b, c] = [0, 1, 2].map(place);
        0.5 * f64::from((b - a).perp_dot(c - a).abs())
    });
    let (_, area) = mesh.volume_and_area();
    (area / texels.sum::<f64>()).sqrt() as f32
}

#[cfg(test)]
mod tests;
