use super::measured::conductor;
use super::*;

const PAGE: &str = include_str!("../../../../../docs/scene_files.md");

/// Checks the page's table of metals: base colours, and the largest error of Schlick's approximation from them, over all
/// angles, against the exact colour of a smooth surface.
#[test]
fn table_of_metals_is_current() {
    let mut table = String::new();
    for metal in Metal::ALL {
        let exact = metal.reflected(1.0);
        let f0 = metal.base_color().as_dvec3();
        let (mut worst, mut angle) = (0.0f64, 0);
        for degrees in 0..=90 {
            let cosine = f64::from(degrees).to_radians().cos().max(0.0);
            let schlick = f0 + (1.0 - f0) * (1.0 - cosine).powi(5);
            let error = (schlick - metal.reflected(cosine).clamp(DVec3::ZERO, DVec3::ONE)).abs().max_element();
            if error > worst {
                (worst, angle) = (error, degrees);
            }
        }
        let cut = (exact - f0).abs().max_element();
        let [red, green, blue] = f0.to_array();
        let name = metal.name();
        table += &format!("| `{name}` | {red:.3}, {green:.3}, {blue:.3} | {cut:.3} | {worst:.3} at {angle}° |\n");
    }
    assert!(PAGE.contains(&table), "docs/scene_files.md should hold:\n{table}");
}

/// The reflectance head on is ((n - 1)² + k²) / ((n + 1)² + k²), that at a grazing angle 1; without absorption, Brewster's
/// angle leaves half of the squared reflectance across the plane of incidence.
#[test]
fn conductors_reflect_as_fresnel_says() {
    for (n, k) in [(0.2f64, 3.4f64), (1.5, 0.0), (2.0, 4.0), (0.05, 2.0)] {
        let wanted = ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
        assert!((conductor(n, k, 1.0) - wanted).abs() < 1e-12, "{n} {k}");
        assert!((conductor(n, k, 0.0) - 1.0).abs() < 1e-12, "{n} {k}");
    }
    let brewster = 1.5f64.atan().cos();
    let across = ((1.0 - 1.5f64 * 1.5) / (1.0 + 1.5 * 1.5)).powi(2);
    assert!((conductor(1.5, 0.0, brewster) - 0.5 * across).abs() < 1e-12);
}

/// Measured rows cover the visible wavelengths in order, so that nothing is extrapolated.
#[test]
fn measured_rows_are_in_order() {
    for constants in
        [measured::GOLD, measured::SILVER, measured::COPPER, measured::RHODIUM, measured::PLATINUM, measured::STEEL]
    {
        assert!(constants.is_sorted_by(|one, next| one[0] < next[0]));
        assert!(constants[0][0] <= spectrum::SHORTEST && constants[constants.len() - 1][0] >= spectrum::LONGEST);
    }
}

#[test]
fn metals_are_sound_materials() {
    for metal in Metal::ALL {
        let material = metal.material();
        assert_eq!(material.problem(), None, "{metal:?}");
        assert!(material.is_opaque() && material.metallic == 1.0, "{metal:?}");
    }
}

#[test]
fn metals_have_their_colours() {
    for metal in Metal::ALL {
        let [red, green, blue] = metal.base_color().to_array();
        let warm = matches!(metal, Metal::Gold | Metal::YellowGold | Metal::RoseGold | Metal::Copper);
        assert_eq!(red - blue > 0.2, warm, "{metal:?}");
        assert!(red >= green && green >= blue && blue > 0.2, "{metal:?}");
    }
    // An alloy is paler than fine gold, and redder with more copper.
    let ratio = |metal: Metal| metal.base_color().x / metal.base_color().y;
    assert!(Metal::YellowGold.base_color().z > Metal::Gold.base_color().z);
    assert!(ratio(Metal::Copper) > ratio(Metal::RoseGold) && ratio(Metal::RoseGold) > ratio(Metal::YellowGold));
}
