//! The recipes' geometries in Rust: `gem_vertex`, `gem_enter` and `gem_hit` of each, from the
//! mirrors.

use super::surface::SurfacePoint;
use crate::error::RenderError;
use crate::settings::Settings;
use crate::stone::facet_map::Walked;
use glam::{Vec3, Vec4};
use lapidary_bvh_trace::{BvhTraceHit, traversal};
use lapidary_closest_point as closest_point;
use lapidary_convex_trace::{self as convex_trace, CONVEX_TRACE_FAR, CONVEX_TRACE_NONE, ConvexTraceHit};
use lapidary_convex_walk::{self as convex_walk, CONVEX_WALK_STEPS};
use lapidary_plan::{Effect, Geometry};
use lapidary_proxy_geometry::{self as proxy_geometry, ProxyGeometryPlane};
use lapidary_scene::normals::soft_normals;
use lapidary_scene::{Bvh, Convex, Mesh, Object, convex};
use std::borrow::Cow;

/// An object with the data that its rung's geometry needs.
pub struct Stone<'a> {
    mesh: &'a Mesh,
    /// One normal per position, for the proxy.
    normals: Cow<'a, [Vec3]>,
    paper_centre: bool,
    data: Data,
}

enum Data {
    Proxy,
    Convex(Convex),
    Walk(Walked),
    Triangles(Leaves),
    Bvh(Leaves),
}

/// A hierarchy, and the place in it of each of the mesh's triangles.
struct Leaves {
    bvh: Bvh,
    place: Vec<u32>,
}

impl Leaves {
    fn of(mesh: &Mesh) -> Self {
        let bvh = Bvh::build(&mesh.positions, &mesh.indices);
        let mut place = vec![u32::MAX; mesh.triangle_count()];
        for (leaf, &triangle) in (0..).zip(&bvh.order) {
            place[triangle as usize] = leaf;
        }
        Self { bvh, place }
    }
}

/// A triangle as the vertex shader passes it on, and where a ray enters it.
pub(super) struct Entry<'a> {
    pub(super) position: Vec3,
    pub(super) face_normal: Vec3,
    start: Place<'a>,
}

/// State of a ray inside that determines its next facet.
#[derive(Clone)]
pub(super) enum Place<'a> {
    Proxy { plane: ProxyGeometryPlane, centre: Vec3, normal: Vec3 },
    Convex { convex: &'a Convex, face: u32 },
    Walk { stone: &'a Walked, face: u32, position: Vec3 },
    Triangles { bvh: &'a Bvh, triangle: u32 },
    Bvh { bvh: &'a Bvh, triangle: u32 },
}

/// The next facet that a ray meets.
pub(super) struct Hit {
    pub(super) point: Vec3,
    pub(super) normal: Vec3,
    pub(super) distance: f32,
    /// Number that identifies the facet; `None` on a miss.
    pub(super) facet: Option<u64>,
}

impl Hit {
    fn none(position: Vec3, direction: Vec3) -> Self {
        Self { point: position, normal: -direction, distance: 0.0, facet: None }
    }
}

impl<'a> Stone<'a> {
    /// Prepares `object` for the geometry of the settings' rung: if it consists of copies, their
    /// shape.
    pub fn new(object: &'a Object, settings: &Settings) -> Result<Self, RenderError> {
        let joined = settings.without.has(Effect::Instances);
        let mesh = if joined { &object.mesh } else { object.shape() };
        let not_convex = |reason| RenderError::NotConvex { object: object.name.clone(), reason };
        let normals = match settings.rung.geometry() {
            Geometry::Proxy => soft_normals(mesh),
            _ => Cow::Borrowed(&mesh.normals[..]),
        };
        let data = match settings.rung.geometry() {
            Geometry::Proxy => Data::Proxy,
            Geometry::Convex => Data::Convex(Convex::of_mesh(mesh).ok_or_else(|| not_convex(convex::obstacle(mesh)))?),
            Geometry::Walk => Data::Walk(Walked::of_mesh(mesh).map_err(not_convex)?),
            Geometry::Triangles => Data::Triangles(Leaves::of(mesh)),
            Geometry::Bvh | Geometry::Scene => Data::Bvh(Leaves::of(mesh)),
        };
        Ok(Self { mesh, normals, paper_centre: settings.gem.paper_centre, data })
    }

    pub(super) fn entry(&self, point: SurfacePoint) -> Entry<'_> {
        let SurfacePoint { position, triangle } = point;
        let mesh = self.mesh;
        let corners = &mesh.indices[3 * triangle as usize..][..3];
        let [a, b, c] = [0, 1, 2].map(|k| mesh.positions[corners[k] as usize]);
        let face_normal = proxy_geometry::face_normal(a, b, c);
        match &self.data {
            Data::Proxy => {
                let [na, nb, nc] = [0, 1, 2].map(|k| self.normals[corners[k] as usize]);
                let mut centre = if self.paper_centre {
                    closest_point::centre_paper(a, na, b, nb, c, nc)
                } else {
                    closest_point::centre(a, na, b, nb, c, nc)
                };
                if face_normal.dot(a - centre) <= 0.0 {
                    centre = closest_point::fallback(a, b, c);
                }
                let plane = proxy_geometry::plane(centre, a, b, c);
                Entry { position, face_normal, start: Place::Proxy { plane, centre, normal: face_normal } }
            }
            Data::Convex(convex) => {
                let face = convex.face_of_triangle[triangle as usize];
                let face_normal = convex.planes[face as usize].truncate();
                Entry { position, face_normal, start: Place::Convex { convex, face } }
            }
            Data::Walk(stone) => {
                let face = stone.convex.face_of_triangle[triangle as usize];
                let face_normal = stone.convex.planes[face as usize].truncate();
                Entry { position, face_normal, start: Place::Walk { stone, face, position: position - stone.centre } }
            }
            Data::Triangles(Leaves { bvh, place }) => {
                let triangle = place[triangle as usize];
                Entry { position, face_normal, start: Place::Triangles { bvh, triangle } }
            }
            Data::Bvh(Leaves { bvh, place }) => {
                let triangle = place[triangle as usize];
                Entry { position, face_normal, start: Place::Bvh { bvh, triangle } }
            }
        }
    }
}

impl<'a> Entry<'a> {
    pub(super) fn enter(&self) -> Place<'a> {
        self.start.clone()
    }
}

impl Place<'_> {
    /// `gem_hit_both` of the recipes, for two rays by position and direction.
    pub(super) fn hit_both(&mut self, ray: (Vec3, Vec3), other: &mut Self, ray_other: (Vec3, Vec3)) -> [Hit; 2] {
        let (Self::Walk { stone, face, position: start }, Self::Walk { face: face_other, position: start_other, .. }) =
            (&mut *self, &mut *other)
        else {
            return [self.hit(ray.0, ray.1), other.hit(ray_other.0, ray_other.1)];
        };
        let (left, left_other) = (*face, *face_other);
        let beyond = convex_trace::start(convex_walk::exit(*start, ray.1, stone.map.lower, stone.map.upper));
        let mut also = convex_trace::start(CONVEX_TRACE_FAR);
        let nearest = walk(stone, beyond, (*start, ray.1), *face, &mut |candidate| {
            let plane = stone.convex.planes[candidate as usize];
            also = convex_trace::step(also, *start_other, ray_other.1, plane, candidate, *face_other);
        });
        if also.face != nearest.face || left_other != left {
            also = walk(stone, also, (*start_other, ray_other.1), *face_other, &mut |_| {});
        }
        [met(stone, face, start, ray, nearest), met(stone, face_other, start_other, ray_other, also)]
    }

    /// `gem_hit` of the recipes.
    pub(super) fn hit(&mut self, position: Vec3, direction: Vec3) -> Hit {
        match self {
            Self::Proxy { plane, centre, normal } => {
                let hit = proxy_geometry::intersect(position, direction, plane.origin, *normal);
                if !hit.hit {
                    return Hit::none(position, direction);
                }
                let coordinates =
                    proxy_geometry::coordinates(hit.point, plane.origin, plane.edge_first, plane.edge_second);
                let cell = proxy_geometry::cell(coordinates);
                let facet = proxy_geometry::facet(*plane, cell);
                let normal = proxy_geometry::facet_normal(
                    *centre,
                    facet.vertex_first,
                    facet.vertex_second,
                    facet.vertex_third,
                    direction,
                );
                *plane = proxy_geometry::next_plane(*centre, facet);
                // Steps are far below 2^30 for any sane stone, so that the low 31 bits of x, in two's
                // complement, still tell all steps apart.
                let [x, y] = cell.steps.to_array().map(|step| u64::from(step.cast_unsigned()));
                let facet = x << 33 | (y & 0xffff_ffff) << 1 | u64::from(cell.turned);
                Hit { point: hit.point, normal, distance: hit.distance, facet: Some(facet) }
            }
            Self::Convex { convex, face } => {
                let nearest = convex_trace::trace(&convex.planes, position, direction, *face);
                let Some(&plane) = convex.planes.get(nearest.face as usize) else {
                    return Hit::none(position, direction);
                };
                *face = nearest.face;
                Hit {
                    point: convex_trace::point(position, direction, nearest.distance, plane),
                    normal: -plane.truncate(),
                    distance: nearest.distance,
                    facet: Some(u64::from(nearest.face)),
                }
            }
            Self::Walk { stone, face, position: start } => {
                let beyond =
                    convex_trace::start(convex_walk::exit(*start, direction, stone.map.lower, stone.map.upper));
                let nearest = walk(stone, beyond, (*start, direction), *face, &mut |_| {});
                met(stone, face, start, (position, direction), nearest)
            }
            Self::Triangles { bvh, triangle } => {
                let nearest = traversal::trace_all(
                    &bvh.nodes,
                    &bvh.corners,
                    position,
                    direction,
                    *triangle,
                    lapidary_bvh_trace::triangle,
                );
                triangle_hit(&bvh.corners, nearest, triangle, position, direction)
            }
            Self::Bvh { bvh, triangle } => {
                let nearest = traversal::trace(&bvh.nodes, &bvh.corners, position, direction, *triangle);
                triangle_hit(&bvh.corners, nearest, triangle, position, direction)
            }
        }
    }
}

/// `gem_walk` of the recipe `gem_walk`; `tested` also gets the number of each plane that is tested.
fn walk(
    Walked { convex, map, .. }: &Walked,
    so_far: ConvexTraceHit,
    (start, direction): (Vec3, Vec3),
    left: u32,
    tested: &mut dyn FnMut(u32),
) -> ConvexTraceHit {
    let mut nearest = so_far;
    let mut words = 0;
    while words < CONVEX_WALK_STEPS {
        let before = nearest.face;
        for (number, candidate) in (0..).zip(map.candidates(start + nearest.distance * direction)) {
            // Two candidates a word.
            words += number % 2;
            let plane = convex.planes[candidate as usize];
            nearest = convex_trace::step(nearest, start, direction, plane, candidate, left);
            tested(candidate);
        }
        if nearest.face == before {
            break;
        }
    }
    nearest
}

/// `gem_met` of the recipe `gem_walk`.
fn met(
    Walked { convex, centre, .. }: &Walked,
    face: &mut u32,
    start: &mut Vec3,
    (position, direction): (Vec3, Vec3),
    nearest: ConvexTraceHit,
) -> Hit {
    if nearest.face == CONVEX_TRACE_NONE {
        return Hit::none(position, direction);
    }
    let plane = convex.planes[nearest.face as usize];
    *face = nearest.face;
    *start = convex_trace::point(*start, direction, nearest.distance, plane);
    Hit {
        point: *start + *centre,
        normal: -plane.truncate(),
        distance: nearest.distance,
        facet: Some(u64::from(nearest.face)),
    }
}

/// The end of `gem_hit` in both recipes that intersect triangles.
fn triangle_hit(corners: &[Vec4], nearest: BvhTraceHit, left: &mut u32, position: Vec3, direction: Vec3) -> Hit {
    let Some([a, b, c]) = corners.get(3 * nearest.triangle as usize..).and_then(|rest| rest.first_chunk()) else {
        return Hit::none(position, direction);
    };
    *left = nearest.triangle;
    Hit {
        point: position + nearest.distance * direction,
        normal: -proxy_geometry::face_normal(a.truncate(), b.truncate(), c.truncate()),
        distance: nearest.distance,
        facet: Some(u64::from(nearest.triangle)),
    }
}
