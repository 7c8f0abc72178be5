//! Plane P behind a facet, its tiles, and the tile that a ray meets.

use super::plane::{Oblique, at};
use super::scene::{ACCENT, Anchor, DIM, INK, Paint, SECOND, Scene};
use super::sheet::Diagram;
use glam::{DVec2, IVec2, Vec3, vec3};
use lapidary_closest_point::{centre, direction};
use lapidary_proxy_geometry::{
    ProxyGeometryCell, ProxyGeometryFacet, ProxyGeometryPlane, cell, coordinates, facet, facet_normal, image,
    intersect, plane,
};
use lapidary_refraction::refract;

pub const DIAGRAM: Diagram = Diagram {
    name: "proxy_geometry",
    module: "proxy_geometry",
    title: "The proxy plane and its tiles",
    caption: "The facet that a ray enters by is mirrored through the centre o, which makes one tile of plane P, twice \
              as deep as the centre. Shifted and turned copies tile the rest. The refracted ray meets one of them, and \
              there the stone's back faces the centre: its normal points from the tile's centroid G to o.",
    draw,
};

/// The facet.
const CORNERS: [Vec3; 3] = [vec3(-0.62, -0.5, 0.0), vec3(0.68, -0.42, 0.0), vec3(-0.05, 0.72, 0.0)];
/// Where the sphere's middle lies from which the normals come.
const MIDDLE: Vec3 = vec3(-0.1, 0.05, -0.82);
/// The ray's place on the facet and its direction.
const RAY: (Vec3, Vec3) = (vec3(0.2, -0.12, 0.0), vec3(0.87, -0.02, -0.5));

/// What the ray meets.
pub struct Met {
    /// The stone's guessed centre.
    pub centre: Vec3,
    /// Plane P.
    pub plane: ProxyGeometryPlane,
    /// Where the ray meets it.
    pub point: Vec3,
    /// The tile there.
    pub tile: ProxyGeometryFacet,
    /// The tile's normal.
    pub normal: Vec3,
}

/// Follows the ray into the stone, by the modules.
pub fn met() -> Met {
    let [a, b, c] = CORNERS;
    let [p, q, r] = CORNERS.map(|corner| direction(corner - MIDDLE));
    let centre = centre(a, p, b, q, c, r);
    let plane = plane(centre, a, b, c);
    let inside = refract(RAY.1.normalize(), Vec3::Z, 1.77).direction;
    let hit = intersect(RAY.0, inside, plane.origin, Vec3::Z);
    let cell = cell(coordinates(hit.point, plane.origin, plane.edge_first, plane.edge_second));
    let tile = facet(plane, cell);
    let normal = facet_normal(centre, tile.vertex_first, tile.vertex_second, tile.vertex_third, inside);
    Met { centre, plane, point: hit.point, tile, normal }
}

fn corners(tile: ProxyGeometryFacet) -> [Vec3; 3] {
    [tile.vertex_first, tile.vertex_second, tile.vertex_third]
}

fn draw() -> Scene {
    let mut scene = Scene::new(720, 434);
    let view = Oblique { origin: at(315.0, 112.0), scale: 142.0, depth: DVec2::new(0.36, -0.42) };
    let met = met();
    tiles(&mut scene, &view, &met);
    through_the_centre(&mut scene, &view, &met);
    ray(&mut scene, &view, &met);
    scene
}

/// Plane P with its tiles.
fn tiles(scene: &mut Scene, view: &Oblique, met: &Met) {
    let first_tile = ProxyGeometryCell { steps: IVec2::ZERO, turned: false };
    for (i, j, turned) in (-2..2).flat_map(|i| (-1..1).flat_map(move |j| [false, true].map(|turned| (i, j, turned)))) {
        let tile = ProxyGeometryCell { steps: IVec2::new(i, j), turned };
        let outline = view.all(&corners(facet(met.plane, tile)));
        scene.area(&outline, Paint::Dim, if turned { 0.07 } else { 0.16 });
        scene.outline(&outline, DIM.thin());
    }
    let image = view.all(&corners(facet(met.plane, first_tile)));
    scene.area(&image, Paint::Accent, 0.3).outline(&image, INK);
    let tile = view.all(&corners(met.tile));
    scene.area(&tile, Paint::Second, 0.3).outline(&tile, SECOND).named("tile");
}

/// The facet, and its image through the centre.
fn through_the_centre(scene: &mut Scene, view: &Oblique, met: &Met) {
    for corner in CORNERS {
        scene.line(&[view.at(corner), view.at(image(met.centre, corner))], DIM.thin().dashed());
    }
    let top = view.all(&CORNERS);
    scene.area(&top, Paint::Accent, 0.3).outline(&top, INK);
    scene.dot(view.at(met.centre), 6.0, Paint::Ink);
    scene.symbol(view.at(met.centre) + at(-24.0, 0.0), Anchor::Middle, Paint::Ink, "'o");
    for (index, corner) in CORNERS.into_iter().enumerate() {
        let aside = [at(-22.0, 6.0), at(24.0, 8.0), at(-22.0, -10.0)][index];
        scene.symbol(view.at(corner) + aside, Anchor::Middle, Paint::Ink, &format!("'x_{index}"));
        let aside = [at(-8.0, 30.0), at(-24.0, -14.0), at(0.0, 22.0)][index];
        let place = view.at(image(met.centre, corner)) + aside;
        scene.symbol(place, Anchor::Middle, Paint::Ink, &format!("'x′_{index}"));
    }
}

/// The ray, and the tile's normal.
fn ray(scene: &mut Scene, view: &Oblique, met: &Met) {
    let (place, direction) = (RAY.0, RAY.1.normalize());
    scene.arrow(&view.all(&[place - 1.1 * direction, place]), ACCENT.wide());
    scene.arrow(&view.all(&[place, met.point]), ACCENT.wide()).named("refracted");
    let middle = corners(met.tile).into_iter().sum::<Vec3>() / 3.0;
    scene.line(&view.all(&[middle, met.centre]), SECOND.thin().dashed());
    scene.arrow(&view.all(&[middle, middle + 0.5 * met.normal]), SECOND.wide()).named("normal");
    scene.dot(view.at(middle), 4.0, Paint::Second);
    scene.symbol(view.at(middle) + at(20.0, 8.0), Anchor::Middle, Paint::Second, "'G");
    scene.symbol(view.at(middle + 0.5 * met.normal) + at(40.0, -18.0), Anchor::Middle, Paint::Second, "'n^t");
    scene.symbol(view.at(place - 1.1 * direction) + at(0.0, -18.0), Anchor::Middle, Paint::Accent, "'r");
    scene.symbol(view.at(place.lerp(met.point, 0.45)) + at(26.0, -8.0), Anchor::Middle, Paint::Accent, "'r^t");
    scene.note(at(20.0, 414.0), Anchor::Start, Paint::Dim, "plane $P$");
}
