use glam::Vec3;

use super::*;
use crate::built_in::framing::framed;
use crate::cuts::{
    BrilliantParameters, PrismParameters, StepCutParameters, octahedron, prism, round_brilliant, step_cut,
};
use crate::surfaces::{sphere, torus};
use crate::{Averaging, Coverage, Material, Mesh};

fn brilliant() -> Mesh {
    round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap().to_mesh(Averaging::Angle)
}

fn scene(objects: Vec<Object>) -> Scene {
    framed("ring", objects, Vec3::Z)
}

fn plastic(name: &str) -> Material {
    Material { name: name.to_owned(), ..Material::standard() }
}

fn metal(name: &str, color: Vec3) -> Material {
    Material { metallic: 1.0, base_color: color, ..plastic(name) }
}

fn looks(name: &str, mesh: Mesh, material: Material) -> Option<Look> {
    look(&Object::new(name, mesh, material)).map(|(look, _)| look)
}

#[test]
fn a_cut_stone_is_told_by_its_shape_however_it_is_written() {
    let ways = [
        plastic("Material.001"),
        Material { coverage: Some(Coverage { share: 0.3, cutoff: None }), ..plastic("m") },
        Material { transmission: 1.0, ..plastic("glass") },
        metal("mirror", Vec3::ONE),
    ];
    let step = step_cut(&StepCutParameters::EMERALD).unwrap().to_mesh(Averaging::Angle);
    for way in ways {
        for cut in [brilliant(), step.clone()] {
            assert_eq!(looks("node 7", cut, way.clone()), Some(Look::Stone("diamond")), "{}", way.name);
        }
    }
    // What is marked already is not guessed.
    assert_eq!(looks("gem", brilliant(), Material { transmission: 1.0, thickness: 1.0, ..plastic("gem") }), None);
    let mut open = brilliant();
    open.indices.drain(..30);
    assert_eq!(looks("node 7", open, plastic("m")), None);
}

#[test]
fn other_shapes_are_stones_only_by_name() {
    let pentagon = || prism(&PrismParameters::PENTAGONAL).unwrap().to_mesh(Averaging::Angle);
    let shapes = [octahedron().unwrap().to_mesh(Averaging::Angle), sphere(1.0, 24), pentagon()];
    for mesh in shapes {
        assert_eq!(looks("thing", mesh.clone(), plastic("m")), None);
        assert_eq!(looks("Gem.003", mesh.clone(), plastic("m")), Some(Look::Stone("diamond")));
        assert_eq!(looks("thing", mesh, plastic("czerwony kamień")), Some(Look::Stone("diamond")));
    }
    // A ring is no stone, whatever its name.
    assert_eq!(looks("diamond ring", torus(2.0, 0.3, 40, 20), plastic("m")), None);
}

/// A mesh with the normals of its triangles.
fn flat(mesh: &Mesh) -> Mesh {
    let triangles: Vec<[Vec3; 3]> = mesh.triangles().collect();
    let normal = |[a, b, c]: &[Vec3; 3]| (*b - *a).cross(*c - *a).normalize_or_zero();
    Mesh {
        positions: triangles.iter().flatten().copied().collect(),
        normals: triangles.iter().flat_map(|corners| [normal(corners); 3]).collect(),
        indices: (0..3 * triangles.len() as u32).collect(),
        ..Mesh::default()
    }
}

/// A mesh with dents and bulges.
fn waved(mut mesh: Mesh) -> Mesh {
    for position in &mut mesh.positions {
        // By the place alone: corners that are written twice stay one.
        let wave = (40.0 * position.x).sin() * (47.0 * position.z).sin() * (31.0 * position.y + 1.0).cos();
        *position *= 1.0 + 0.1 * wave;
    }
    mesh
}

/// Stones that were modelled by hand have facets that are bent by a hundredth of their size; what is hollow has as many.
#[test]
fn a_stone_with_bent_facets_is_told_from_a_ring() {
    let bent = flat(&waved(brilliant()));
    let cut = Cut::of(&bent);
    assert!(cut.is_stone(), "{cut:?}");
    let object = Object::new("Cylinder", bent, plastic("_Glass"));
    let (look, evidence) = look(&object).expect("a stone");
    assert_eq!(look, Look::Stone("diamond"));
    assert!(evidence[0].starts_with("closed, though not convex (9"), "{evidence:?}");
    // A smooth body is one by its name alone.
    let Mesh { positions, indices, .. } = waved(sphere(1.0, 20));
    let pebble = Mesh::with_shared_normals(positions, indices, Averaging::Angle);
    let cut = Cut::of(&pebble);
    assert!(!cut.is_faceted() && cut.to_string().starts_with("closed, though not convex (9"), "{cut:?}");
    assert_eq!(looks("thing", pebble.clone(), plastic("m")), None);
    assert_eq!(looks("Gem", pebble, plastic("m")), Some(Look::Stone("diamond")));
    let ring = flat(&torus(2.0, 0.5, 12, 6));
    let cut = Cut::of(&ring);
    assert!(cut.is_closed() && cut.is_faceted() && !cut.is_stone(), "{cut:?}");
    assert_eq!(looks("Cylinder", ring, plastic("_Glass")), None);
}

#[test]
fn a_drum_of_many_sides_is_no_stone() {
    let side = |k: u32| std::f32::consts::TAU * k as f32 / 24.0;
    let mut positions: Vec<Vec3> =
        (0..24).flat_map(|k| [-0.5, 0.5].map(|y| Vec3::new(side(k).cos(), y, side(k).sin()))).collect();
    positions.extend([Vec3::new(0.0, -0.5, 0.0), Vec3::new(0.0, 0.5, 0.0)]);
    let facets = (0..24).flat_map(|k| {
        let [a, b, c, d] = [2 * k, 2 * k + 1, 2 * ((k + 1) % 24), 2 * ((k + 1) % 24) + 1];
        [a, b, c, c, b, d, 48, a, c, 49, d, b]
    });
    let drum = flat(&Mesh::with_shared_normals(positions, facets.collect(), Averaging::Angle));
    let cut = Cut::of(&drum);
    assert!(cut.is_nearly_convex() && cut.is_faceted() && cut.is_closed() && !cut.is_stone(), "{cut:?}");
}

#[test]
fn names_and_colours_choose_the_preset() {
    let stone = |name: &str, color: Vec3| looks(name, brilliant(), Material { base_color: color, ..plastic("m") });
    for (name, preset) in [
        ("Rubis_02", "ruby"),
        ("blueSapphire", "sapphire"),
        ("SZMARAGD", "emerald"),
        ("Stone CZ 1.2mm", "zirconia"),
        ("Brillanten", "diamond"),
        ("Edelstein", "diamond"),
        ("钻石1", "diamond"),
        ("Рубин", "ruby"),
    ] {
        assert_eq!(stone(name, Vec3::ONE), Some(Look::Stone(preset)), "{name}");
    }
    for (color, preset) in [
        (Vec3::new(0.8, 0.02, 0.1), "ruby"),
        (Vec3::new(0.1, 0.7, 0.3), "emerald"),
        (Vec3::new(0.02, 0.1, 0.6), "sapphire"),
        (Vec3::new(0.8, 0.8, 0.9), "diamond"),
        (Vec3::new(0.8, 0.7, 0.1), "diamond"),
    ] {
        assert_eq!(stone("node", color), Some(Look::Stone(preset)), "{color}");
    }
}

#[test]
fn words_count_whole_alone() {
    let words = |name: &str| Words::of([&name.to_owned(), &String::new()]);
    let nothing = [
        "Gemini",
        "stonework",
        "Goldilocks",
        "diameter",
        "orbit",
        "Steinway",
        "silverware",
        "Regem",
        "ruben",
        "category",
    ];
    for name in nothing {
        assert_eq!(words(name), Words { stone: None, metal: None }, "{name}");
    }
    for name in ["GemStone", "gem_01", "Gems", "big-gem", "Gem.001", "PIERRE 3", "kamień"] {
        assert!(words(name).stone.is_some(), "{name}");
    }
    let metals = [
        ("Rose Gold 18k", Metal::RoseGold),
        ("yellow_gold", Metal::YellowGold),
        ("whiteGold", Metal::WhiteGold),
        ("Weißgold", Metal::WhiteGold),
        ("WEIẞGOLD 585", Metal::WhiteGold),
        ("złoto", Metal::Gold),
        ("ALTİN", Metal::Gold),
        ("Argent", Metal::Silver),
        ("PLATIN", Metal::Platinum),
        ("Metal steel", Metal::Steel),
    ];
    for (name, metal) in metals {
        assert_eq!(words(name).metal.map(|(_, metal)| metal), Some(Some(metal)), "{name}");
    }
    assert_eq!(words("prongs").metal, Some(("prongs".to_owned(), None)));
}

/// Some programs write a letter and its accent as two characters.
#[test]
fn decomposed_letters_are_letters() {
    for (composed, decomposed) in [
        ("émeraude", "e\u{301}meraude"),
        ("gyémánt", "gye\u{301}ma\u{301}nt"),
        ("kamień", "kamien\u{301}"),
        ("zümrüt", "zu\u{308}mru\u{308}t"),
        ("ダイヤモンド", "タ\u{3099}イヤモント\u{3099}"),
    ] {
        let stones = [composed, decomposed].map(|name| Words::of([&name.to_owned(), &String::new()]).stone);
        assert!(stones[0].is_some() && stones[0] == stones[1], "{composed}: {stones:?}");
    }
}

#[test]
fn metals_are_told_by_name() {
    let band = || torus(2.0, 0.3, 40, 20);
    assert_eq!(looks("band", band(), plastic("m")), None);
    assert_eq!(looks("band", band(), plastic("Gold")), Some(Look::Metal(Metal::Gold)));
    assert_eq!(looks("ring or band", band(), plastic("m")), None);
    assert_eq!(looks("or", band(), metal("m", Vec3::ONE)), Some(Look::Metal(Metal::Gold)));
    // What is marked as a metal keeps its colour.
    assert_eq!(looks("gold", band(), metal("m", Vec3::new(0.9, 0.7, 0.1))), None);
    assert_eq!(looks("band", band(), metal("m", Vec3::ONE)), None);
    // A metal by name is no stone, though it is cut like one.
    assert_eq!(looks("silver bead", brilliant(), plastic("m")), Some(Look::Metal(Metal::Silver)));
    // A clear body is none.
    assert_eq!(looks("gold", band(), Material { transmission: 1.0, metallic: 1.0, ..plastic("m") }), None);
}

/// A metal whose name does not say which is the one whose base colour is nearest, also in the shade.
#[test]
fn metals_are_told_by_colour() {
    let found = |color: Vec3| looks("Metall", torus(2.0, 0.3, 40, 20), Material { base_color: color, ..plastic("m") });
    for metal in Metal::ALL {
        assert_eq!(found(metal.base_color()), Some(Look::Metal(metal)), "{}", metal.name());
        // The preset's name, as the page on scene files lists it.
        assert_eq!(Look::Metal(metal).to_string(), format!("a metal, {}", metal.name()));
    }
    for shade in [0.5, 0.1] {
        for metal in [Metal::Gold, Metal::Copper] {
            assert_eq!(found(shade * metal.base_color()), Some(Look::Metal(metal)), "{shade} {}", metal.name());
        }
    }
    // Colours that artists give metals.
    for (color, metal) in [
        (Vec3::new(1.0, 0.766, 0.336), Metal::Gold),
        (Vec3::new(0.955, 0.638, 0.538), Metal::Copper),
        (Vec3::new(0.972, 0.96, 0.915), Metal::Silver),
        (Vec3::ONE, Metal::Silver),
        (Vec3::splat(0.56), Metal::Steel),
        (Vec3::ZERO, Metal::Steel),
    ] {
        assert_eq!(found(color), Some(Look::Metal(metal)), "{color}");
    }
}

#[test]
fn bodies_of_one_material_are_one_guess_with_its_option() {
    let guesses = guesses(
        &scene(vec![
            Object::new("a", brilliant(), plastic("Gem")),
            Object::new("b", brilliant(), plastic("Gem")),
            Object::new("gold band", torus(2.0, 0.3, 40, 20), plastic("m")),
            Object::new("table", torus(9.0, 0.3, 40, 20), plastic("paint")),
            Object::new("it's", brilliant(), plastic("paint")),
            Object::new("given", brilliant(), plastic("other")),
        ]),
        |body| body == 5,
    );
    let [gems, band, one] = &guesses[..] else { panic!("{guesses:?}") };
    assert_eq!(
        gems.to_string(),
        "2 objects, first `a` of `Gem`: looks like a stone, diamond (its name says `gem`, closed and convex, 73 facets)"
    );
    assert_eq!((&*gems.options(), &gems.bodies[..]), ("--material 'Gem=diamond'", &[0, 1][..]));
    assert_eq!(band.look, Look::Metal(Metal::Gold));
    assert_eq!(one.options(), r"--material 'it'\''s=diamond'");
}
