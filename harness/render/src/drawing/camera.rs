//! The camera's matrix, for the whole picture or for one of its tiles.

use crate::picture::Tile;
use glam::Mat4;
use lapidary_scene::Scene;

/// Returns the matrix from world space to the clip space of `tile` in a picture of `width` ×
/// `height` pixels. Depth runs from 0 (near) to 1 (far).
pub(crate) fn clip_from_world(scene: &Scene, width: u32, height: u32, tile: Tile) -> Mat4 {
    tile_from_picture(width, height, tile) * lapidary_scene::clip_from_world(scene, width, height)
}

/// Returns the matrix that scales the tile's part of clip space up to all of clip space.
fn tile_from_picture(width: u32, height: u32, tile: Tile) -> Mat4 {
    let scale_x = width as f32 / tile.width as f32;
    let scale_y = height as f32 / tile.height as f32;
    // Centre of the tile in the picture's clip space, y up.
    let middle_x = (2.0 * tile.left as f32 + tile.width as f32) / width as f32 - 1.0;
    let middle_y = 1.0 - (2.0 * tile.top as f32 + tile.height as f32) / height as f32;
    Mat4::from_cols_array(&[
        scale_x,
        0.0,
        0.0,
        0.0,
        0.0,
        scale_y,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
        0.0,
        -scale_x * middle_x,
        -scale_y * middle_y,
        0.0,
        1.0,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn the_whole_picture_is_its_own_tile() {
        let whole = Tile { left: 0, top: 0, width: 640, height: 480 };
        assert_eq!(tile_from_picture(640, 480, whole), Mat4::IDENTITY);
    }

    #[test]
    fn a_tiles_corners_become_the_corners_of_clip_space() {
        let tile = Tile { left: 512, top: 256, width: 128, height: 224 };
        let matrix = tile_from_picture(640, 480, tile);
        let clip = |x: f32, y: f32| matrix.project_point3(Vec3::new(2.0 * x / 640.0 - 1.0, 1.0 - 2.0 * y / 480.0, 0.5));
        assert!(clip(512.0, 256.0).abs_diff_eq(Vec3::new(-1.0, 1.0, 0.5), 1e-5));
        assert!(clip(640.0, 480.0).abs_diff_eq(Vec3::new(1.0, -1.0, 0.5), 1e-5));
    }
}
