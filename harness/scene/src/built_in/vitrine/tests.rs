use super::*;
use crate::{Bounds, Mineral};

/// One body for each technique, each with the properties that select it and no others.
#[test]
fn each_body_has_what_calls_for_its_technique() {
    let scene = Scene::named("vitrine").expect("built in");
    let names: Vec<&str> = scene.objects.iter().map(|object| object.name.as_str()).collect();
    assert_eq!(
        names,
        ["table", "diamond", "ruby", "candle", "figure", "prism_chain", "ball", "foot", "post", "arm", "hook"]
    );
    let [table, diamond, ruby, candle, figure, chain, ball, stand @ ..] = &scene.objects[..] else {
        panic!("{names:?}")
    };
    for opaque in stand.iter().chain([table]) {
        assert_eq!((opaque.material.transmission, opaque.material.thickness), (0.0, 0.0));
    }
    for stone in [diamond, ruby, chain] {
        let material = &stone.material;
        assert_eq!((material.transmission, material.roughness), (1.0, 0.0), "{}", stone.name);
        assert!(material.thickness > 5.0 && material.medium.is_none() && material.sigma0.is_none());
    }
    assert_eq!(diamond.material.dispersion, Dispersion::Sellmeier(Mineral::Diamond));
    assert_eq!((ruby.material.dispersion, ruby.material.ior), (Dispersion::None, Mineral::Corundum.index()));
    assert_eq!(chain.material.dispersion, Dispersion::None);
    assert_eq!([diamond, ruby, chain].map(|stone| stone.material.absorbs()), [false, true, false]);
    // The ruby has the colour of the built-in ruby, reached after two girdle radii.
    assert_eq!(ruby.material.attenuation_distance, 2.0 * RUBY);
    for (body, spreads) in [(candle, false), (figure, false), (ball, true)] {
        assert_eq!(
            (body.material.sigma0.is_some(), body.material.thickness > 0.0),
            (spreads, spreads),
            "{}",
            body.name
        );
        assert!(body.material.medium.is_some());
    }
}

/// The bounding boxes of any two bodies are disjoint, and so are the bodies.
#[test]
fn all_stand_on_the_table_or_hang_above_it_and_none_reaches_into_another() {
    let scene = Scene::named("vitrine").expect("built in");
    let bounds = |object: &Object| Bounds::of(object.mesh.positions.iter().copied());
    let table = bounds(&scene.objects[0]);
    assert!(table.max.y.abs() < 1e-5);
    for (k, object) in scene.objects.iter().enumerate().skip(1) {
        let extent = bounds(object);
        let stands = (0.01..0.03).contains(&extent.min.y);
        let hangs = extent.min.y > 3.9;
        let above = ["prism_chain", "post", "arm", "hook"].contains(&object.name.as_str());
        assert_eq!((stands, hangs), (!above, above), "{extent:?}");
        // At some distance from the table's edge.
        let margin = (extent.min - table.min).min(table.max - extent.max);
        assert!(margin.x > 10.0 && margin.z > 10.0, "{}: {margin}", object.name);
        for other in &scene.objects[k + 1..] {
            let others = bounds(other);
            let are_disjoint = extent.max.cmplt(others.min).any() || others.max.cmplt(extent.min).any();
            assert!(are_disjoint, "{} and {}", object.name, other.name);
        }
    }
    // The stones rest on a facet: as many vertices touch the table as the facet has corners.
    for stone in &scene.objects[1..3] {
        let touching = stone.mesh.positions.iter().filter(|position| position.y < 0.02 + 1e-4).count();
        assert_eq!(touching, 4, "{}", stone.name);
    }
}
