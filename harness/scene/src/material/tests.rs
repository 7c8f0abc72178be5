use super::*;

#[test]
fn minerals_have_their_equations_index_and_abbe_number() {
    for mineral in Mineral::ALL {
        // The d, F and C lines.
        let [d, f, c] = [587.561_8, 486.132_7, 656.272_5].map(|line| dispersion::sellmeier(mineral.sellmeier(), line));
        // Rounding to five decimals, and below to one: half a unit of the last, plus f32 rounding.
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
    for bad in [-0.1, 1.1, f32::NAN] {
        assert!(Material { roughness: bad, ..Material::standard() }.problem().unwrap().contains("roughness"));
    }
    for bad in [Vec3::new(0.0, -1e-9, 0.0), Vec3::NAN, Vec3::INFINITY] {
        let good = Medium::isotropic(Vec3::ONE, Vec3::ZERO);
        let problem = |material: Material| material.problem().unwrap_or("");
        assert_eq!(
            problem(Material { sigma0: Some(Vec3::ZERO), medium: Some(good.clone()), ..Material::standard() }),
            ""
        );
        assert!(problem(Material { sigma0: Some(bad), ..Material::standard() }).contains("sigma0"));
        for medium in [Medium { scattering: bad, ..good.clone() }, Medium { absorption: bad, ..good }] {
            assert!(problem(Material { medium: Some(medium), ..Material::standard() }).contains("scattering"));
        }
    }
}
