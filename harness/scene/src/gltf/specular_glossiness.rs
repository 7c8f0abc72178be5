//! `KHR_materials_pbrSpecularGlossiness`, the archived form of materials, as factors of the metallic-roughness form.

use glam::Vec3;

use super::extension::Extension;

/// Reflectance at normal incidence that a dielectric of glTF has, by index 1.5.
const DIELECTRIC: f32 = 0.04;

/// Name of the extension.
pub(super) const NAME: &str = "KHR_materials_pbrSpecularGlossiness";

/// Its member that stands for `baseColorTexture`.
pub(super) const DIFFUSE_TEXTURE: &str = "diffuseTexture";

/// Factors of the metallic-roughness form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Factors {
    /// Linear red, green and blue, and alpha.
    pub(super) base_color: [f32; 4],
    pub(super) metallic: f32,
    pub(super) roughness: f32,
}

/// Reads the factors of the extension: the surface of the same diffuse and specular reflectance, as far as base colour and metallic
/// factor can express both (the conversion of Khronos's repository of the extension).
pub(super) fn factors(extension: Extension<'_>) -> Result<Factors, String> {
    let [red, green, blue, alpha] =
        extension.four_numbers("diffuseFactor")?.unwrap_or([1.0; 4]).map(|part| part as f32);
    let diffuse = Vec3::new(red, green, blue);
    if ![red, green, blue, alpha].iter().all(|part| (0.0..=1.0).contains(part)) {
        return Err(format!(
            "its diffuseFactor is {:?}, but each part must lie from 0 to 1",
            [red, green, blue, alpha]
        ));
    }
    let specular = extension.color("specularFactor")?.unwrap_or(Vec3::ONE);
    let roughness = 1.0 - extension.share("glossinessFactor")?.unwrap_or(1.0);
    let left = (1.0 - specular.max_element()) / (1.0 - DIELECTRIC);
    let metallic = metallic(brightness(diffuse) * left, brightness(specular));
    let by_diffuse = diffuse * left / (1.0 - metallic).max(f32::EPSILON);
    let by_specular = (specular - DIELECTRIC * (1.0 - metallic)) / metallic.max(f32::EPSILON);
    let base_color = by_diffuse.lerp(by_specular, metallic * metallic).clamp(Vec3::ZERO, Vec3::ONE);
    Ok(Factors { base_color: base_color.extend(alpha).to_array(), metallic, roughness })
}

/// Returns the metallic factor m of a base colour b with b (1 - m) = `diffuse` and .04 (1 - m) + b m = `specular`.
fn metallic(diffuse: f32, specular: f32) -> f32 {
    if specular <= DIELECTRIC {
        return 0.0;
    }
    // .04 m² + p m + .04 - specular = 0, by the form of the root without cancellation: the constant is below 0.
    let p = diffuse + specular - 2.0 * DIELECTRIC;
    let c = DIELECTRIC - specular;
    let root = (p * p - 4.0 * DIELECTRIC * c).sqrt();
    let metallic = if p >= 0.0 { -2.0 * c / (p + root) } else { (root - p) / (2.0 * DIELECTRIC) };
    metallic.clamp(0.0, 1.0)
}

fn brightness(color: Vec3) -> f32 {
    (color * color).dot(Vec3::new(0.299, 0.587, 0.114)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn of(diffuse: [f32; 4], specular: [f32; 3], gloss: f32) -> Factors {
        let value = json!({"diffuseFactor": diffuse, "specularFactor": specular, "glossinessFactor": gloss});
        factors(Extension::inside(&value)).unwrap()
    }

    /// A metal has no diffuse reflectance, and a dielectric the specular one of .04.
    #[test]
    fn metals_and_dielectrics_come_back() {
        let gold = of([0.0, 0.0, 0.0, 1.0], [1.0, 0.78, 0.34], 0.75);
        assert!(gold.metallic > 0.999 && gold.roughness == 0.25, "{gold:?}");
        assert!(Vec3::from_slice(&gold.base_color).distance(Vec3::new(1.0, 0.78, 0.34)) < 1e-3, "{gold:?}");
        let paint = of([0.5, 0.25, 0.125, 0.5], [0.04; 3], 1.0);
        assert!(paint.metallic < 1e-6 && paint.base_color[3] == 0.5, "{paint:?}");
        assert!(Vec3::from_slice(&paint.base_color).distance(Vec3::new(0.5, 0.25, 0.125)) < 1e-6, "{paint:?}");
        assert_eq!(of([0.2, 0.2, 0.2, 1.0], [0.0; 3], 0.0).metallic, 0.0);
    }

    /// The reflectances of a grey surface, for which brightness is linear, come back.
    #[test]
    fn grey_mixtures_keep_both_reflectances() {
        for (base, metallic) in [(0.7_f32, 0.3_f32), (0.2, 0.9), (0.9, 0.05), (0.05, 0.5)] {
            let diffuse = base * (1.0 - metallic);
            let specular = DIELECTRIC * (1.0 - metallic) + base * metallic;
            // The extension dims the diffuse part by the largest specular one.
            let stated = diffuse * (1.0 - DIELECTRIC) / (1.0 - specular);
            let found = of([stated, stated, stated, 1.0], [specular; 3], 0.5);
            assert!((found.metallic - metallic).abs() < 1e-4, "{found:?} {metallic}");
            assert!((found.base_color[0] - base).abs() < 1e-4, "{found:?} {base}");
        }
    }

    #[test]
    fn numbers_outside_their_range_are_refused() {
        for (member, value) in [
            ("diffuseFactor", json!([0.5, 0.5, 0.5])),
            ("diffuseFactor", json!([0.5, 0.5, 1.5, 1.0])),
            ("specularFactor", json!([0.5, -0.5, 0.5])),
            ("glossinessFactor", json!(2)),
        ] {
            let value = json!({member: value});
            assert!(factors(Extension::inside(&value)).unwrap_err().starts_with(&format!("its {member} is ")));
        }
    }
}
