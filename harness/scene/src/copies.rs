//! Copies of one shape at many places, which a renderer may draw in one call.

use glam::{DMat4, DQuat, DVec3, Mat3, Quat, Vec3, Vec4};

use super::{Material, Mesh};

/// Maximum number of vertices, and of triangle corners, in one mesh of copies. The longest list built from them is a hierarchy
/// with at most a node of 64 bytes for each triangle: 85 MiB, which any device holds in one buffer (WebGPU guarantees 128 MiB).
pub const MOST_JOINED: usize = 1 << 22;

/// One shape and the places at which a body shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Copies {
    /// The surface in its own space.
    pub shape: Mesh,
    /// The places, at least one.
    pub places: Vec<Place>,
}

/// Place and colours of a copy. A copy is turned, scaled alike in all directions, and moved, so that
/// all its angles are the shape's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Rotation, a unit quaternion.
    pub rotation: Quat,
    /// Length in world space of a unit of length of the shape, above 0.
    pub scale: f32,
    /// World position of the shape's origin.
    pub translation: Vec3,
    /// Factor of the material's base colour, linear RGB.
    pub base_color: Vec3,
    /// Attenuation colour in place of the material's; `None` for the material's.
    pub attenuation_color: Option<Vec3>,
}

impl Place {
    /// The shape's own place: copies there are the shape itself.
    pub const IDENTITY: Self = Self {
        rotation: Quat::IDENTITY,
        scale: 1.0,
        translation: Vec3::ZERO,
        base_color: Vec3::ONE,
        attenuation_color: None,
    };

    /// Returns the transform from the shape's space to world space.
    #[must_use]
    pub fn transform(&self) -> DMat4 {
        let (scale, rotation) = (DVec3::splat(f64::from(self.scale)), self.rotation.as_dquat());
        // As the loader does, to the last bit.
        let rotation = rotation / rotation.length();
        DMat4::from_scale_rotation_translation(scale, rotation, self.translation.as_dvec3())
    }

    /// Returns the place to which `transform` takes a shape, or `None` if it does more than turn,
    /// scale alike in all directions, and move.
    #[must_use]
    pub fn of_transform(transform: DMat4) -> Option<Self> {
        let columns = [transform.x_axis, transform.y_axis, transform.z_axis].map(|column| column.truncate());
        let lengths = columns.map(DVec3::length);
        let scale = lengths.iter().sum::<f64>() / 3.0;
        let even = lengths.iter().all(|length| (length - scale).abs() <= SKEW * scale);
        let [x, y, z] = columns;
        let square = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|cosine| cosine.abs() <= SKEW * scale * scale);
        let upright = x.cross(y).dot(z) > 0.0;
        let proper = scale.is_finite() && scale > 0.0 && scale <= f64::from(f32::MAX) && even && square && upright;
        proper.then(|| {
            let rotation = DQuat::from_mat3(&glam::DMat3::from_cols(x / scale, y / scale, z / scale)).normalize();
            Self {
                rotation: rotation.as_quat(),
                scale: scale as f32,
                translation: transform.w_axis.truncate().as_vec3(),
                ..Self::IDENTITY
            }
        })
    }

    /// Returns the rows of the matrix from the shape's space to world space, as a shader reads them.
    #[must_use]
    pub fn rows(&self) -> [Vec4; 3] {
        let turn = Mat3::from_quat(self.rotation.normalize()) * self.scale;
        [0, 1, 2].map(|row| turn.row(row).extend(self.translation[row]))
    }

    /// Returns the material of the copy.
    #[must_use]
    pub fn material(&self, original: &Material) -> Material {
        let attenuation_color = self.attenuation_color.unwrap_or(original.attenuation_color);
        Material { base_color: original.base_color * self.base_color, attenuation_color, ..original.clone() }
    }
}

/// Largest relative difference of a transform's lengths, and largest cosine between its axes, that
/// still count as equal and as square: what f32 leaves of a product of a few rotations.
const SKEW: f64 = 1.0 / (1 << 19) as f64;

impl Copies {
    /// Returns all copies as one mesh in world space.
    #[must_use]
    pub fn joined(&self) -> Mesh {
        let mut all = Mesh::default();
        self.places.iter().for_each(|place| all.append(&self.shape.transformed(place.transform())));
        all
    }

    /// Whether the copies differ in colour, so that one material is not enough for them.
    #[must_use]
    pub fn is_coloured(&self) -> bool {
        self.places.iter().any(|place| place.base_color != Vec3::ONE || place.attenuation_color.is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place() -> Place {
        let rotation = Quat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0);
        Place { rotation, scale: 2.5, translation: Vec3::new(1.0, -2.0, 3.0), ..Place::IDENTITY }
    }

    #[test]
    fn a_place_comes_back_from_its_transform() {
        let again = Place::of_transform(place().transform()).expect("a place");
        assert!(again.rotation.dot(place().rotation).abs() > 1.0 - 1e-6);
        assert!((again.scale - 2.5).abs() < 1e-6 && again.translation == place().translation);
    }

    #[test]
    fn a_mirrored_or_skewed_transform_is_no_place() {
        for wrong in [DVec3::new(1.0, 1.0, -1.0), DVec3::new(1.0, 1.0, 1.001), DVec3::ZERO, DVec3::splat(f64::NAN)] {
            assert_eq!(Place::of_transform(DMat4::from_scale(wrong)), None, "{wrong}");
        }
        let mut skewed = DMat4::IDENTITY;
        skewed.y_axis.x = 0.01;
        assert_eq!(Place::of_transform(skewed), None);
    }

    #[test]
    fn rows_take_a_point_where_the_transform_does() {
        let point = Vec3::new(0.2, 0.7, -0.4);
        let rows = place().rows().map(|row| row.dot(point.extend(1.0)));
        assert!(Vec3::from(rows).distance(place().transform().transform_point3(point.as_dvec3()).as_vec3()) < 1e-6);
    }
}
