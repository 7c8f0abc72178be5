//! The refractive index at a wavelength.

use crate::scene::{Dispersion, Material, Mineral};

/// n of `material` at `nanometres`, relative to air.
pub(super) fn index(material: &Material, nanometres: f64) -> f64 {
    let at_d = f64::from(material.ior);
    match material.dispersion {
        Dispersion::None => at_d,
        Dispersion::Abbe(dispersion) => abbe(at_d, 20.0 / f64::from(dispersion), nanometres),
        Dispersion::Sellmeier(mineral) => sellmeier(mineral, nanometres),
    }
}

/// glTF's `KHR_materials_dispersion`: Cauchy's equation through the index at the d line with Abbe number `abbe`.
fn abbe(at_d: f64, abbe: f64, nanometres: f64) -> f64 {
    (at_d + (at_d - 1.0) / abbe * (523_655.0 / (nanometres * nanometres) - 1.5168)).max(1.0)
}

/// n² = constant + Σ B λ²/(λ² - C²), λ in µm. Diamond: Peter 1923; corundum: Malitson; quartz: Ghosh; N-BK7: Schott;
/// cubic zirconia: Wood.
#[rustfmt::skip] // a mineral is a line of terms (B, C²)
fn sellmeier(mineral: Mineral, nanometres: f64) -> f64 {
    let square = |c: f64| c * c;
    let (constant, terms) = match mineral {
        Mineral::Diamond => (1.0, [(0.3306, square(0.1750)), (4.3356, square(0.1060)), (0.0, 0.0)]),
        Mineral::Corundum => (1.0,
            [(1.4313493, square(0.0726631)), (0.65054713, square(0.1193242)), (5.3414021, square(18.028251))]),
        Mineral::Quartz => (1.28604141, [(1.07044083, 0.0100585997), (1.10202242, 100.0), (0.0, 0.0)]),
        Mineral::CrownGlass => (1.0,
            [(1.03961212, 0.00600069867), (0.231792344, 0.0200179144), (1.01046945, 103.560653)]),
        Mineral::CubicZirconia => (1.0,
            [(1.347091, square(0.062543)), (2.117788, square(0.166739)), (9.452943, square(24.320570))]),
    };
    let lambda_squared = square(nanometres / 1000.0);
    let sum: f64 = terms.iter().map(|(b, c_squared)| b * lambda_squared / (lambda_squared - c_squared)).sum();
    (constant + sum).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MINERALS: [(Mineral, f64, f64, f64); 5] = [
        (Mineral::Diamond, 2.41749, 55.3, 0.0444),
        (Mineral::Corundum, 1.76817, 72.3, 0.0181),
        (Mineral::Quartz, 1.54428, 69.7, 0.0133),
        (Mineral::CrownGlass, 1.51680, 64.2, 0.0138),
        (Mineral::CubicZirconia, 2.15877, 33.5, 0.0604),
    ];

    /// n_d, V_d and n_G - n_B at the Fraunhofer lines.
    #[test]
    fn minerals_have_their_published_indices() {
        for (mineral, at_d, number, spread) in MINERALS {
            let n = |nanometres| sellmeier(mineral, nanometres);
            assert!((n(587.6) - at_d).abs() < 1e-5, "{mineral:?}: {}", n(587.6));
            assert!(((n(587.6) - 1.0) / (n(486.1) - n(656.3)) - number).abs() < 0.06, "{mineral:?}");
            assert!((n(430.8) - n(686.7) - spread).abs() < 6e-5, "{mineral:?}");
        }
    }

    #[test]
    fn an_abbe_number_comes_near_the_sellmeier_equation() {
        for (mineral, at_d, number, spread) in MINERALS {
            let material = Material {
                ior: at_d as f32,
                dispersion: Dispersion::Abbe(20.0 / number as f32),
                ..Material::standard()
            };
            assert!((index(&material, 587.6) - at_d).abs() < 1e-4 * spread);
            for nanometres in [420.0, 500.0, 650.0] {
                let difference = index(&material, nanometres) - sellmeier(mineral, nanometres);
                assert!(difference.abs() < 0.1 * spread, "{mineral:?} at {nanometres}: {difference}");
            }
        }
        let flat = Material { ior: 2.5, ..Material::standard() };
        assert_eq!(index(&flat, 400.0), 2.5);
        assert_eq!(abbe(1.05, 0.1, 700.0), 1.0);
    }
}
