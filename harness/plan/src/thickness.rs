//! The thickness of a body, and the technique that follows from it for a scattering body.

use crate::remembered::Remembered;
use glam::Vec3;
use lapidary_bvh_trace::traversal;
use lapidary_scene::{Bvh, Material, Medium, Mesh, Object};

/// Maximum thickness, in mean free paths, of a body through which light shows; see
/// [`Thickness::shows_through`].
pub const MOST_MEAN_FREE_PATHS: f32 = 16.0;

/// Number of rays that measure a body.
const RAYS: usize = 1024;
/// Share of a body's surface that may be thinner than its thickness.
const THIN_SHARE: f64 = 0.1;

/// Thickness of a scattering body, and the length to compare it with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thickness {
    /// Thickness in units of length.
    pub thickness: f32,
    /// Whether the file gives the thickness; otherwise it was measured.
    pub is_given: bool,
    /// Transport mean free path in units of length, for the colour that travels farthest, at the
    /// lowest density; infinite without scattering and absorption.
    pub mean_free_path: f32,
}

impl Thickness {
    /// Returns the thickness of a body with a medium: the material's if it gives one, else the
    /// measured one.
    #[must_use]
    pub fn of(object: &Object, medium: &Medium) -> Self {
        let given = object.material.thickness;
        let thickness = if given > 0.0 { given } else { measured(&object.mesh) };
        Self { thickness, is_given: given > 0.0, mean_free_path: mean_free_path(medium) }
    }

    /// Returns the thickness in mean free paths.
    #[must_use]
    pub fn mean_free_paths(self) -> f32 {
        self.thickness / self.mean_free_path
    }

    /// Whether light that falls on one side is seen on the other.
    ///
    /// In diffusion theory a slab of N mean free paths without absorption transmits (5/3)/(N + 4/3)
    /// of diffuse light: a tenth for 16, and less with absorption. Thinner bodies need light paths
    /// through the body. In thicker ones only the light near the surface is visible, and the
    /// curvature of the surface is enough.
    #[must_use]
    pub fn shows_through(self) -> bool {
        self.mean_free_paths() <= MOST_MEAN_FREE_PATHS
    }
}

fn mean_free_path(medium: &Medium) -> f32 {
    1.0 / (medium.transport_extinction().min_element() * medium.density.least())
}

/// Returns the thickness that all but a tenth of the surface reaches, measured straight inwards to
/// the next surface; 0 for a mesh without an inside. The thin parts of a body decide, since light
/// shows through them.
#[must_use]
pub fn measured(mesh: &Mesh) -> f32 {
    static MEASURED: Remembered<f32> = Remembered::new();
    MEASURED.of(mesh, measured_anew)
}

fn measured_anew(mesh: &Mesh) -> f32 {
    let bvh = Bvh::build(&mesh.positions, &mesh.indices);
    let triangles: Vec<[Vec3; 3]> =
        bvh.indices.chunks_exact(3).map(|corners| corner_positions(mesh, corners)).collect();
    let areas: Vec<f64> = triangles.iter().map(|[a, b, c]| f64::from((b - a).cross(c - a).length())).collect();
    let total: f64 = areas.iter().sum();
    if !(total > 0.0 && total.is_finite()) {
        return 0.0;
    }
    // One ray per fixed amount of area, so that each part of the surface counts by its size and the
    // same mesh always gives the same result.
    let step = total / RAYS as f64;
    let mut lengths = Vec::new();
    let (mut behind, mut next) = (0.0, 0.5 * step);
    for ((number, triangle), area) in (0..).zip(&triangles).zip(&areas) {
        behind += area;
        while next < behind {
            lengths.extend(inwards(&bvh, number, triangle));
            next += step;
        }
    }
    lengths.sort_by(f32::total_cmp);
    lengths.get((THIN_SHARE * lengths.len() as f64) as usize).copied().unwrap_or(0.0)
}

fn corner_positions(mesh: &Mesh, corners: &[u32]) -> [Vec3; 3] {
    [0, 1, 2].map(|k| mesh.positions[corners[k] as usize])
}

/// Returns the distance inwards from a triangle's centre, along its normal; `None` without a hit.
fn inwards(bvh: &Bvh, number: u32, [a, b, c]: &[Vec3; 3]) -> Option<f32> {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let middle = (a + b + c) / 3.0;
    let hit = traversal::trace(&bvh.nodes, &bvh.corners, middle, -normal, number);
    (normal != Vec3::ZERO && traversal::met(&hit)).then_some(hit.distance)
}

/// Returns the width of [`sigma0_of`] in mean free paths for an albedo.
fn widths(albedo: Vec3) -> Vec3 {
    0.5 + 4.3 * albedo
}

/// Returns the width that spreads light over a curved body of this medium, for red, green and blue
/// in units of length. It replaces `sigma0` if a material has none.
///
/// Random walks through spheres of ten mean free paths give (0.5 + 4.3 albedo) mean free paths,
/// within 4 % for the albedos of skin, wax and jade.
#[must_use]
pub fn sigma0_of(medium: &Medium) -> Vec3 {
    let (scattering, extinction) = (medium.reduced_scattering(), medium.transport_extinction());
    let width = |channel: usize| {
        let free = 1.0 / extinction[channel];
        if free.is_finite() { widths(scattering * free)[channel] * free } else { 0.0 }
    };
    Vec3::new(width(0), width(1), width(2))
}

/// Returns the share of light that one scattering leaves, for red, green and blue, as if scattering were
/// isotropic; `None` without a medium.
#[must_use]
pub fn albedo(material: &Material) -> Option<Vec3> {
    let medium = material.medium.as_ref()?;
    let (scattering, extinction) = (medium.reduced_scattering(), medium.transport_extinction());
    Some(Vec3::select(extinction.cmpgt(Vec3::ZERO), scattering / extinction, Vec3::ZERO))
}

/// Returns the colour of a scattering body: the reflectance of a half space of its medium without a boundary; the base colour
/// if it has no medium, or if an image or `colors` of the mesh say where it has which.
#[must_use]
pub fn color(material: &Material, colors: &[Vec3]) -> Vec3 {
    let is_even = material.base_color_texture.is_none() && colors.is_empty();
    let of_albedo = |albedo| lapidary_half_space::reflectance(lapidary_half_space::gamma(albedo, 0.0));
    let of_medium = albedo(material).filter(|_| is_even).map(|albedo| albedo.map(of_albedo));
    of_medium.unwrap_or(material.base_color)
}

/// Returns the transport mean free path for red, green and blue, in units of length: the medium's, or else
/// that of the matter that has the material's base color and `sigma0`; `None` if it has neither.
#[must_use]
pub fn free_path(material: &Material) -> Option<Vec3> {
    if let Some(medium) = &material.medium {
        return Some(medium.transport_extinction().recip());
    }
    let gamma = material.base_color.map(lapidary_half_space::gamma_of_reflectance);
    Some(material.sigma0? / widths(Vec3::ONE - gamma * gamma))
}

/// Returns the material's own `sigma0`, or [`sigma0_of`] its medium; `None` if it has neither.
#[must_use]
pub fn sigma0(material: &Material) -> Option<Vec3> {
    material.sigma0.or_else(|| material.medium.as_ref().map(sigma0_of))
}

#[cfg(test)]
mod tests {
    use super::*;
    use lapidary_scene::Scene;

    fn object(scene: &str, number: usize) -> Object {
        Scene::named(scene).expect("built in").objects[number].clone()
    }

    #[test]
    fn a_sphere_is_as_thick_as_its_diameter_and_a_slab_as_its_edge() {
        // The triangles lie inside the sphere, and their centres deeper still.
        let sphere = object("wax", 0);
        assert!((measured(&sphere.mesh) / 80.0 - 1.0).abs() < 0.01, "{}", measured(&sphere.mesh));
        let [low, high] = [Vec3::ZERO, Vec3::new(10.0, 1.0, 10.0)];
        let corner = |k: u32| Vec3::select(glam::BVec3::new(k & 1 != 0, k & 2 != 0, k & 4 != 0), high, low);
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let indices = faces.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
        let slab = Mesh::with_shared_normals((0..8).map(corner).collect(), indices, lapidary_scene::Averaging::Angle);
        assert_eq!(measured(&slab), 1.0);
        assert_eq!(measured(&Mesh::default()), 0.0);
    }

    #[test]
    fn thin_parts_decide() {
        let bunny = object("bunny", 0);
        let thickness = Thickness::of(&bunny, bunny.material.medium.as_ref().expect("marble"));
        // The ears and the edge of the tail: a few of the bunny's 60 mm.
        assert!((2.0..12.0).contains(&thickness.thickness), "{thickness:?}");
        let given = Object { material: Material { thickness: 30.0, ..bunny.material.clone() }, ..bunny };
        let medium = given.material.medium.clone().expect("marble");
        let thickness = Thickness::of(&given, &medium);
        assert!(thickness.is_given && thickness.thickness == 30.0 && !thickness.shows_through(), "{thickness:?}");
        let least = medium.scattering.x + medium.absorption.x;
        assert!((thickness.mean_free_paths() / (30.0 * least) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn widths_are_those_of_the_fitted_spheres() {
        for (scene, fitted) in [("skin", [5.8, 3.8, 2.3]), ("wax", [4.0, 4.0, 4.1]), ("jade", [4.6, 3.9, 4.5])] {
            let material = object(scene, 0).material;
            let sigma0 = sigma0_of(&material.medium.expect("scattering"));
            for (given, fitted) in sigma0.to_array().into_iter().zip(fitted) {
                assert!((given / fitted - 1.0).abs() < 0.04, "{scene}: {sigma0}");
            }
        }
    }
}
