use super::*;

/// n² by the mineral's Sellmeier equation at a wavelength in micrometres, as in the sources.
fn squared_index(mineral: Mineral, wavelength: f64) -> f64 {
    let square = wavelength * wavelength;
    // Terms B λ²/(λ² - C²), with C² given.
    let sum = |terms: &[(f64, f64)]| terms.iter().map(|(b, c)| b * square / (square - c)).sum::<f64>();
    let from_c = |terms: [(f64, f64); 3]| sum(&terms.map(|(b, c)| (b, c * c)));
    1.0 + match mineral {
        Mineral::Diamond => from_c([(0.3306, 0.1750), (4.3356, 0.1060), (0.0, 0.0)]),
        Mineral::Corundum => {
            from_c([(1.431_349_3, 0.072_663_1), (0.650_547_13, 0.119_324_2), (5.341_402_1, 18.028_251)])
        }
        Mineral::Quartz => 0.286_041_41 + sum(&[(1.070_440_83, 0.010_058_599_7), (1.102_022_42, 100.0)]),
        Mineral::CrownGlass => {
            sum(&[(1.039_612_12, 0.006_000_698_67), (0.231_792_344, 0.020_017_914_4), (1.010_469_45, 103.560_653)])
        }
        Mineral::CubicZirconia => from_c([(1.347_091, 0.062_543), (2.117_788, 0.166_739), (9.452_943, 24.320_570)]),
    }
}

#[test]
fn minerals_have_their_equations_index_and_abbe_number() {
    for mineral in Mineral::ALL {
        // The d, F and C lines.
        let [d, f, c] = [0.587_561_8, 0.486_132_7, 0.656_272_5].map(|line| squared_index(mineral, line).sqrt());
        // Five decimals, and one: half a unit of the last, and f32's own.
        assert!((f64::from(mineral.index()) - d).abs() < 5.2e-6, "{mineral:?}: {d}");
        let abbe_number = (d - 1.0) / (f - c);
        assert!((f64::from(mineral.abbe_number()) - abbe_number).abs() < 0.0501, "{mineral:?}: {abbe_number}");
    }
}

#[test]
fn minerals_are_found_by_their_names_alone() {
    for mineral in Mineral::ALL {
        assert_eq!(Mineral::named(mineral.name()), Some(mineral));
    }
    for other in ["", "Diamond", "diamond ", "glass"] {
        assert_eq!(Mineral::named(other), None);
    }
}

#[test]
fn broken_promises_are_named() {
    let said = |change: fn(&mut Material)| {
        let mut material = Material::standard();
        change(&mut material);
        material.problem().unwrap_or("")
    };
    assert_eq!(said(|_| ()), "");
    assert_eq!(said(|m| m.attenuation_color = Vec3::ZERO), "");
    assert_eq!(said(|m| m.dispersion = Dispersion::Abbe(1e9)), "");
    assert!(said(|m| m.base_color.y = 1.1).contains("base colour"));
    assert!(said(|m| m.base_color.y = f32::NAN).contains("base colour"));
    let indices: [fn(&mut Material); 3] = [|m| m.ior = 0.99, |m| m.ior = f32::NAN, |m| m.ior = f32::INFINITY];
    for bad in indices {
        assert!(said(bad).contains("refractive index"));
    }
    let bad: [fn(&mut Material); 4] = [
        |m| m.dispersion = Dispersion::Abbe(0.0),
        |m| m.dispersion = Dispersion::Abbe(f32::NAN),
        |m| m.dispersion = Dispersion::Abbe(f32::INFINITY),
        |m| m.dispersion = Dispersion::Sellmeier(Mineral::Diamond),
    ];
    for bad in bad {
        assert!(said(bad).contains("dispersion"));
    }
    assert!(said(|m| m.attenuation_color.z = -0.1).contains("attenuation colour"));
    let distances: [fn(&mut Material); 3] =
        [|m| m.attenuation_distance = 0.0, |m| m.attenuation_distance = f32::NAN, |m| m.attenuation_distance = 1e-40];
    for bad in distances {
        assert!(said(bad).contains("attenuation distance"));
    }
}
