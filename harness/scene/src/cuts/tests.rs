use super::*;

fn counts(solid: &Polyhedron) -> (usize, usize, usize) {
    (solid.faces().len(), solid.vertices().len(), solid.edge_count())
}

/// Returns the slope of a facet against the horizontal, in degrees.
fn slope(plane: &Plane) -> f64 {
    plane.normal.z.abs().acos().to_degrees()
}

fn tolkowsky() -> Polyhedron {
    round_brilliant(&BrilliantParameters::TOLKOWSKY).unwrap()
}

#[test]
fn tolkowskys_brilliant_has_its_facets() {
    assert_eq!(counts(&tolkowsky()), (73, 57, 128));
}

#[test]
fn tolkowskys_brilliant_has_its_slopes() {
    let solid = tolkowsky();
    let facets = [
        ("table", 0..1, 0.0),
        ("star", 1..9, 23.07),
        ("bezel", 9..17, 34.5),
        ("upper half", 17..33, 40.58),
        ("girdle", 33..49, 90.0),
        ("lower half", 49..65, 41.94),
        ("main", 65..73, 40.75),
    ];
    for (name, range, expected) in facets {
        for plane in &solid.planes()[range] {
            let found = slope(plane);
            assert!((found - expected).abs() < 0.005, "{name}: {found} is not {expected}");
        }
    }
}

#[test]
fn a_brilliants_girdle_and_culet_lie_where_they_should() {
    let solid = tolkowsky();
    let reach = |f: fn(DVec3) -> f64| solid.vertices().iter().copied().map(f).fold(0.0, f64::max);
    assert!((reach(|v| v.truncate().length()) - 1.0).abs() < 1e-12);
    let culet = 0.02 + 40.75f64.to_radians().tan();
    assert!((reach(|v| -v.z) - culet).abs() < 1e-9);
}

#[test]
fn an_octahedron_is_regular() {
    let solid = octahedron().unwrap();
    assert_eq!(counts(&solid), (8, 6, 12));
    assert!(solid.vertices().iter().all(|v| (v.length() - 1.0).abs() < 1e-12));
}

#[test]
fn an_emerald_cut_has_its_facets_and_proportions() {
    let solid = step_cut(&StepCutParameters::EMERALD).unwrap();
    assert_eq!(counts(&solid), (57, 58, 113));
    let size = |f: fn(DVec3) -> f64| {
        let along = solid.vertices().iter().copied().map(f);
        along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
    };
    let (length, width, depth) = (size(|v| v.x), size(|v| v.y), size(|v| v.z));
    assert!((length - 2.0).abs() < 1e-9 && (length / width - 1.4).abs() < 1e-9);
    assert!((0.60..0.70).contains(&(depth / width)), "depth {}", depth / width);
    for (facet, degrees) in [(1, 42.0), (9, 34.0), (17, 26.0), (33, 52.0), (41, 46.0), (49, 42.0)] {
        assert!((slope(&solid.planes()[facet]) - degrees).abs() < 1e-9);
    }
    let bottom = solid.vertices().iter().map(|v| v.z).fold(0.0, f64::min);
    let keel = solid.vertices().iter().filter(|v| v.z < bottom + 1e-9);
    assert_eq!(keel.count(), 2, "the pavilion must end in a keel");
}

#[test]
fn prisms_have_their_faces() {
    let pentagonal = prism(&PrismParameters::PENTAGONAL).unwrap();
    assert_eq!(counts(&pentagonal), (15, 12, 25));
    for sides in [3, 6, 64] {
        let flat = PrismParameters { sides, cap_degrees: 0.0, ..PrismParameters::PENTAGONAL };
        let n = sides as usize;
        assert_eq!(counts(&prism(&flat).unwrap()), (n + 2, 2 * n, 3 * n));
    }
}

#[test]
fn parameters_out_of_range_are_named() {
    let good = BrilliantParameters::TOLKOWSKY;
    for bad in [0.0, 1.0, -0.5, f64::NAN, f64::INFINITY] {
        let wrong = BrilliantParameters { table: bad, ..good };
        let message = round_brilliant(&wrong).unwrap_err().to_string();
        assert!(message.starts_with("round brilliant: table is"), "{message}");
    }
    let steep = BrilliantParameters { crown_degrees: 90.0, ..good };
    assert!(round_brilliant(&steep).unwrap_err().to_string().contains("crown_degrees is 90"));

    let good = PrismParameters::PENTAGONAL;
    for sides in [0, 2, 65, u32::MAX] {
        let message = prism(&PrismParameters { sides, ..good }).unwrap_err().to_string();
        assert!(message.contains("from 3 to 64"), "{message}");
    }
    assert!(prism(&PrismParameters { radius: f64::NAN, ..good }).is_err());
    assert!(prism(&PrismParameters { cap_degrees: -1.0, ..good }).is_err());

    let mut rising = StepCutParameters::EMERALD;
    rising.crown[1].degrees = 50.0;
    let message = step_cut(&rising).unwrap_err().to_string();
    assert_eq!(message, "step cut: crown is 50, but must lie below the slope of the step before it");
}

#[test]
fn proportions_that_lose_facets_are_refused() {
    let good = BrilliantParameters::TOLKOWSKY;
    for tiny in [1e-9, 1e-12, 1e-15] {
        for bad in [
            BrilliantParameters { star: tiny, ..good },
            BrilliantParameters { girdle: tiny, ..good },
            BrilliantParameters { table: tiny, ..good },
            BrilliantParameters { table: 1.0 - tiny, ..good },
            BrilliantParameters { lower_halves: 1.0 - tiny, ..good },
        ] {
            let error = round_brilliant(&bad).unwrap_err();
            assert!(matches!(error, CutError::Facets { expected: 73, .. }), "{bad:?}: {error}");
        }
        let steep = BrilliantParameters { crown_degrees: 90.0 - tiny, ..good };
        assert!(round_brilliant(&steep).is_err());
    }
}
