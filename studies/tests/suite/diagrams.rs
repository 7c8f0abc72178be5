//! The diagrams in `docs/diagrams` are those that the program draws, each stands on its module's page, and what is
//! drawn obeys the laws that it shows, measured on the sheet.

use lapidary_cookbook::repository;
use lapidary_studies::diagram::scene::{Item, Point, Scene, Shape};
use lapidary_studies::diagram::{Diagram, all};
use lapidary_testing::generated;

#[test]
fn the_diagrams_are_as_drawn() {
    for diagram in all() {
        generated::keep(&format!("docs/diagrams/{}.svg", diagram.name), &diagram.file_text());
    }
    let kept = std::fs::read_dir(repository::place().join("docs/diagrams")).expect("the folder");
    assert_eq!(kept.count(), all().len(), "docs/diagrams holds a file that no diagram is");
}

#[test]
fn each_stands_on_its_modules_page() {
    for Diagram { name, module, caption, .. } in all() {
        let page = std::fs::read_to_string(repository::place().join(format!("docs/{module}.md"))).expect(module);
        let image = format!("![{caption}](diagrams/{name}.svg)\n");
        assert!(page.contains(&image), "docs/{module}.md lacks the line {image}");
    }
}

/// A law, and what is wrong with the scene that breaks it.
type Law = fn(&Scene) -> Result<(), String>;

/// Laws, each with its diagram and the shape that it is about.
const LAWS: &[(&str, &str, Law)] = &[
    ("refraction", "refracted", snell),
    ("refraction", "stays", mirrored),
    ("refraction", "grazes", grazes),
    ("convex_trace", "nearest", leaves_through_the_outline),
    ("voxelization", "inside", filled_by_parity),
    ("curvature", "bump", fits),
    ("screen_trace", "through", on_the_wall),
    ("screen_trace", "on the screen", equal_on_the_screen),
    ("bvh_trace", "ray", ends_on_the_outline),
];

#[test]
fn what_is_drawn_obeys_its_law_and_a_wrong_drawing_does_not() {
    for (name, fact, law) in LAWS {
        let diagram = all().iter().find(|diagram| diagram.name == *name).expect(name);
        let scene = (diagram.draw)();
        law(&scene).unwrap_or_else(|fault| panic!("{name}, {fact}: {fault}"));
        let wrong = moved(&scene, fact);
        assert_ne!(wrong, scene, "{name} has no shape {fact}");
        assert!(law(&wrong).is_err(), "{name}: nobody notices a wrong {fact}");
    }
}

/// Returns the scene with the first shape of a name off by a few units: its end, or all of it.
fn moved(scene: &Scene, fact: &str) -> Scene {
    let mut scene = scene.clone();
    let Some(Item { shape, .. }) = scene.items.iter_mut().find(|item| item.name == Some(fact)) else { return scene };
    match shape {
        Shape::Line { points, .. } | Shape::Area { points, .. } => {
            let end = points.last_mut().expect("a point");
            end.0.x += 6.0;
            end.0.y += 9.0;
        }
        Shape::Cell { at: corner, .. } => corner.0.y += 400.0,
        Shape::Dot { at: middle, .. } => middle.0 += 5.0,
        Shape::Ring { radius, .. } => radius.0 *= 1.1,
        Shape::Arc { .. } | Shape::Label { .. } => unreachable!("no law is about it"),
    }
    scene
}

/// Returns the first and the last point of the line with a name.
fn ends(scene: &Scene, fact: &str) -> [[f64; 2]; 2] {
    let line = scene.of_name(fact).find_map(|shape| match shape {
        Shape::Line { points, .. } => Some(points),
        _ => None,
    });
    let points = line.unwrap_or_else(|| panic!("a line {fact}"));
    [points[0], points[points.len() - 1]].map(|Point(place)| [place.x, place.y])
}

/// Returns the sine of the angle between a line and the sheet's vertical.
fn sine(scene: &Scene, fact: &str) -> f64 {
    let [from, to] = ends(scene, fact);
    let (x, y) = (to[0] - from[0], to[1] - from[1]);
    x / x.hypot(y)
}

fn near(found: f64, expected: f64, tolerance: f64) -> Result<(), String> {
    if (found - expected).abs() <= tolerance { Ok(()) } else { Err(format!("{found} instead of {expected}")) }
}

fn snell(scene: &Scene) -> Result<(), String> {
    near(sine(scene, "refracted") * 2.42, sine(scene, "incident"), 2e-3)
}

fn mirrored(scene: &Scene) -> Result<(), String> {
    near(sine(scene, "stays"), 42.0_f64.to_radians().sin(), 2e-3)?;
    let [from, to] = ends(scene, "stays");
    if to[1] > from[1] { Ok(()) } else { Err("it leaves".to_owned()) }
}

fn grazes(scene: &Scene) -> Result<(), String> {
    near(sine(scene, "grazes"), 1.0, 1e-3)
}

/// Returns the middles of all dots, rings and cells with a name.
fn places(scene: &Scene, fact: &str) -> Vec<[f64; 2]> {
    let place = |shape: &Shape| match shape {
        Shape::Dot { at: middle, .. } | Shape::Ring { at: middle, .. } => middle.0.to_array(),
        Shape::Cell { at: corner, size, .. } => (corner.0 + 0.5 * size.0).to_array(),
        _ => panic!("{fact} is no place"),
    };
    scene.of_name(fact).map(place).collect()
}

/// Returns the corners of the closed outline: the first one, that is no head of an arrow.
fn outline(scene: &Scene) -> Vec<[f64; 2]> {
    let closed = scene.items.iter().filter_map(|item| match &item.shape {
        Shape::Line { points, closed: true, pen, .. } if !pen.dashed && pen.width == "middle" => Some(points),
        _ => None,
    });
    let longest = closed.max_by_key(|points| points.len()).expect("an outline");
    longest.iter().map(|point| point.0.to_array()).collect()
}

/// Returns the sides of an outline.
fn sides(outline: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + '_ {
    (0..outline.len()).map(|k| (outline[k], outline[(k + 1) % outline.len()]))
}

/// Returns the distance of a place from a segment.
fn distance(place: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let (x, y) = (to[0] - from[0], to[1] - from[1]);
    let along = (((place[0] - from[0]) * x + (place[1] - from[1]) * y) / (x * x + y * y)).clamp(0.0, 1.0);
    (place[0] - from[0] - along * x).hypot(place[1] - from[1] - along * y)
}

fn from_outline(scene: &Scene, place: [f64; 2]) -> f64 {
    sides(&outline(scene)).map(|(from, to)| distance(place, from, to)).fold(f64::INFINITY, f64::min)
}

fn leaves_through_the_outline(scene: &Scene) -> Result<(), String> {
    let farther = places(scene, "farther");
    if farther.len() < 2 || farther.iter().any(|place| from_outline(scene, *place) < 20.0) {
        return Err(format!("the farther crossings are {farther:?}"));
    }
    near(from_outline(scene, places(scene, "nearest")[0]), 0.0, 0.1)
}

fn ends_on_the_outline(scene: &Scene) -> Result<(), String> {
    // The line ends where the arrow's head begins; the head's tip is the place.
    let shape = scene.of_name("ray").next();
    let Some(Shape::Line { points, head, .. }) = shape else { return Err("no ray".to_owned()) };
    let (from, base, tip) = (points[0].0, points[points.len() - 1].0, head[0].0);
    let turn = (base - from).normalize().perp_dot((tip - from).normalize());
    near(turn, 0.0, 1e-3)?;
    near(from_outline(scene, tip.to_array()), 0.0, 0.3)
}

/// A voxel's centre is inside an odd number of sides away.
fn filled_by_parity(scene: &Scene) -> Result<(), String> {
    let outline = outline(scene);
    let is_inside = |place: [f64; 2]| {
        let before = |(from, to): &([f64; 2], [f64; 2])| {
            (from[1] > place[1]) != (to[1] > place[1])
                && from[0] + (place[1] - from[1]) / (to[1] - from[1]) * (to[0] - from[0]) < place[0]
        };
        sides(&outline).filter(before).count() % 2 == 1
    };
    let (inside, touched) = (places(scene, "inside"), places(scene, "touched"));
    if inside.is_empty() || touched.is_empty() {
        return Err("no voxels".to_owned());
    }
    if let Some(outside) = inside.iter().find(|place| !is_inside(**place)) {
        return Err(format!("{outside:?} is not inside"));
    }
    match touched.iter().find(|place| is_inside(**place)) {
        Some(place) => Err(format!("{place:?} is inside")),
        None if places(scene, "crossing").len() == 4 => Ok(()),
        None => Err("not four crossings".to_owned()),
    }
}

/// The circle's radius is that of a sine's crest, the inverse of height times frequency squared, on the sheet.
fn fits(scene: &Scene) -> Result<(), String> {
    let radius = |fact: &str| match scene.of_name(fact).next() {
        Some(Shape::Ring { radius, .. }) => radius.0,
        _ => f64::NAN,
    };
    near(radius("bump"), 138.0 / (0.62 * 1.45 * 1.45), 0.2)?;
    near(radius("dent"), radius("bump"), 0.2)
}

fn on_the_wall(scene: &Scene) -> Result<(), String> {
    let mut wide = scene.items.iter().filter_map(|item| match &item.shape {
        Shape::Line { points, pen, head, .. } if pen.width == "wide" && head.is_empty() => Some(points),
        _ => None,
    });
    let [from, to] =
        wide.next_back().map(|points| [points[0], points[1]].map(|point| point.0.to_array())).expect("a wall");
    near(distance(places(scene, "through")[0], from, to), 0.0, 0.1)
}

fn equal_on_the_screen(scene: &Scene) -> Result<(), String> {
    let dots = places(scene, "on the screen");
    let steps: Vec<f64> = dots.windows(2).map(|pair| pair[0][1] - pair[1][1]).collect();
    let (least, most) =
        steps.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), step| (least.min(*step), most.max(*step)));
    near(most, least, 0.01)
}
