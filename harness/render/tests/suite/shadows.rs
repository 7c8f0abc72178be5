//! Cast shadows of bodies that are drawn by their surface. Pixel by pixel, the lights' maps agree
//! with rays through a hierarchy of the triangles.

use glam::{DVec3, Vec3};
use lapidary_bvh_trace::BvhTraceHit;
use lapidary_bvh_trace::traversal::{self, met};
use lapidary_plan::{Effect, Effects, Rung};
use lapidary_render as render;
use lapidary_render::{DiffuseOptions, Settings, ShadowForm};
use lapidary_scene::surfaces::{rounded_box, sphere, torus};
use lapidary_scene::{Bvh, Density, Light, Material, Medium, Mesh, Object, Scene};
use lapidary_testing::pixels::{furthest, rays};
use std::f64::consts::{FRAC_1_PI, PI, TAU};

const SIDE: u32 = 200;
/// Texels along a side of a map, as in the renderer.
const TEXELS: f64 = 1024.0;
/// Least cosine of compared pixels towards the eye, and towards the light for a verdict. At grazing
/// angles the facets of the mesh decide.
const GRAZING: f64 = 0.2;

fn settings(rung: &str) -> Settings {
    Settings {
        rung: rung.parse().expect(rung),
        samples: 1,
        without: Effects::of(&[Effect::Environment]).and(Effects::SHEEN),
        ..Settings::of_size(SIDE, SIDE)
    }
}

/// Returns a lying ring and a ball in the air over its rim: each casts shadows on itself or on the
/// other.
fn scene(light: Light) -> Scene {
    let skin = Scene::named("skin").expect("built in");
    let material = Material { sigma0: Some(Vec3::splat(1.0)), ..skin.objects[0].material.clone() };
    let ball = sphere(3.0, 256).placed(glam::DQuat::IDENTITY, DVec3::new(-4.6, 7.5, -4.6));
    let body = |name: &str, mesh| Object::new(name, mesh, material.clone());
    let objects = vec![body("ring", torus(10.0, 4.0, 256, 128)), body("ball", ball)];
    Scene { objects, lights: vec![light], ..skin }.seen_from(40.0, 120.0)
}

/// All triangles of a scene.
struct Triangles {
    mesh: Mesh,
    bvh: Bvh,
}

impl Triangles {
    fn of(scene: &Scene) -> Self {
        let mut mesh = Mesh::default();
        for object in &scene.objects {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(&object.mesh.positions);
            mesh.normals.extend(&object.mesh.normals);
            // The hierarchy's rays leave a solid through its triangles. A ray from outside meets
            // them if they are turned over.
            let turned = object.mesh.indices.chunks_exact(3).flat_map(|corners| [corners[0], corners[2], corners[1]]);
            mesh.indices.extend(turned.map(|index| first + index));
        }
        let bvh = Bvh::build(&mesh.positions, &mesh.indices);
        Self { mesh, bvh }
    }

    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<BvhTraceHit> {
        let (origin, direction) = (origin.as_vec3(), direction.as_vec3());
        let hit = traversal::trace(&self.bvh.nodes, &self.bvh.corners, origin, direction, u32::MAX);
        met(&hit).then_some(hit)
    }

    /// Returns the normal at a hit, interpolated as in the recipe.
    fn normal(&self, hit: &BvhTraceHit) -> DVec3 {
        let corner = |k: usize| self.mesh.normals[self.bvh.indices[3 * hit.triangle as usize + k] as usize].as_dvec3();
        let [second, third] = hit.barycentrics.to_array().map(f64::from);
        ((1.0 - second - third) * corner(0) + second * corner(1) + third * corner(2)).normalize()
    }

    /// Returns whether anything stands between a place and a light at this distance.
    fn is_hidden(&self, place: DVec3, toward: DVec3, distance: f64) -> bool {
        self.trace(place, toward).is_some_and(|hit| f64::from(hit.distance) < distance)
    }
}

/// Visibility of the light from a pixel, according to rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Seen {
    Lit,
    Dark,
    /// Too near to a shadow's edge, or to the body that casts it, for a map of texels to tell.
    Between,
}

/// Returns whether a point and eight points about it, three texels away, all see the light or all
/// do not. The map's bias is a texel's width and ignores lower obstacles. Rays that must be free
/// therefore start at that height over the surface, and rays that must be hidden start twice as
/// high.
fn seen(triangles: &Triangles, [point, normal]: [DVec3; 2], light: &Light, texel: f64) -> Seen {
    let along = normal.any_orthonormal_vector();
    let across = normal.cross(along);
    let about = (0..8).map(|step| 3.0 * texel * glam::DVec2::from_angle(TAU * f64::from(step) / 8.0));
    let places: Vec<DVec3> = std::iter::once(glam::DVec2::ZERO)
        .chain(about)
        .map(|offset| point + offset.x * along + offset.y * across)
        .collect();
    let hidden = |height: f64| {
        places.iter().filter(move |place| {
            let start = **place + height * texel * normal;
            let arrival = light.arrival(start);
            triangles.is_hidden(start, arrival.direction, arrival.distance)
        })
    };
    if hidden(1.0).count() == 0 {
        Seen::Lit
    } else if hidden(2.0).count() == places.len() {
        Seen::Dark
    } else {
        Seen::Between
    }
}

/// A pixel that is not seen at a grazing angle: its value, the cosine towards the light, the value of
/// the same surface square to the light, and the verdict of the rays.
struct Compared {
    found: f64,
    cosine: f64,
    full: f64,
    seen: Seen,
    index: usize,
}

/// Returns the width of a texel in the world at a point that a light sees. A lamp has several maps,
/// and the tangent of their half angle is at most 1.5.
fn texel(scene: &Scene, light: &Light, point: DVec3) -> f64 {
    match light {
        Light::Directional { .. } => 2.0 * f64::from(scene.bounds().radius()) / TEXELS,
        Light::Point { position, .. } | Light::Spot { position, .. } => {
            3.0 * point.distance(position.as_dvec3()) / TEXELS
        }
    }
}

fn compared(scene: &Scene, light: &Light, pixels: &[[f32; 4]]) -> Vec<Compared> {
    let triangles = Triangles::of(scene);
    let base = f64::from(lapidary_plan::thickness::color(&scene.objects[0].material, &[]).x);
    let eye = scene.camera.eye.as_dvec3();
    let picture = render::Picture {
        width: SIDE,
        height: SIDE,
        linear: pixels.to_vec(),
        encoded: Vec::new(),
        lost: None,
        walked: None,
        notes: Vec::new(),
    };
    let mut all = Vec::new();
    for (index, (direction, pixel)) in rays(scene, &picture).into_iter().enumerate() {
        let Some(hit) = triangles.trace(eye, direction).filter(|_| pixel[3] == 1.0) else { continue };
        let point = eye + f64::from(hit.distance) * direction;
        let normal = triangles.normal(&hit);
        let arrival = light.arrival(point);
        let cosine = normal.dot(arrival.direction);
        if normal.dot(-direction) < GRAZING || arrival.irradiance.x < 1e-2 {
            continue;
        }
        let full = base * arrival.irradiance.x * FRAC_1_PI;
        let seen = if cosine < GRAZING {
            Seen::Between
        } else {
            seen(&triangles, [point, normal], light, texel(scene, light, point))
        };
        all.push(Compared { found: pixel[0].into(), cosine, full, seen, index });
    }
    all
}

/// Returns the numbers of lit, dark and undecided pixels, and the number of lit or dark pixels that
/// the picture shows otherwise.
fn judged(all: &[Compared]) -> [usize; 4] {
    let count = |seen: Seen| all.iter().filter(|one| one.seen == seen && one.cosine >= GRAZING).count();
    let is_wrong = |one: &&Compared| {
        let share = one.found / (one.cosine * one.full);
        // The picture interpolates with perspective in f32, the rays use f64. A pixel's place is
        // off by 1e-6 of its distance of 40, and its cosine by that over the radius. In a spot's
        // soft edge, the light falls to 0 within a fifth of a radian.
        match one.seen {
            Seen::Lit => (share - 1.0).abs() > 2e-3,
            Seen::Dark => share > 1e-6,
            Seen::Between => false,
        }
    };
    [count(Seen::Lit), count(Seen::Dark), count(Seen::Between), all.iter().filter(is_wrong).count()]
}

fn lights() -> [(&'static str, Light); 4] {
    let position = Vec3::new(20.0, 26.0, 16.0);
    let direction = (Vec3::new(6.0, 2.0, 6.0) - position).normalize();
    let (inner_angle, outer_angle) = (0.3, 0.5);
    [
        ("sun", Light::Directional { toward: Vec3::new(0.5, 0.7, 0.5).normalize(), irradiance: Vec3::splat(2.0) }),
        ("lamp", Light::Point { position, intensity: Vec3::splat(1500.0) }),
        ("spot", Light::Spot { position, direction, intensity: Vec3::splat(1500.0), inner_angle, outer_angle }),
        // Among the bodies: six views.
        ("lamp amid the bodies", Light::Point { position: Vec3::new(0.0, 9.0, 0.0), intensity: Vec3::splat(300.0) }),
    ]
}

#[test]
fn shadows_are_those_that_rays_find() {
    let recipe = lapidary_wgsl::recipe_source("cdrf_shading");
    let bias = "let bias = 2.0f * views[layer].view.extent * clip.w / f32(size);";
    assert!(recipe.contains(bias));
    for (name, light) in lapidary_testing::sampled(lights(), 3) {
        let scene = scene(light);
        let settings = settings("lambert-shadowed");
        let counts_of = |source: &str| {
            let picture = render::render_with(lapidary_testing::gpu(), &scene, &settings, source).expect("rendered");
            judged(&compared(&scene, &light, &picture.linear))
        };
        let [lit, dark, between, wrong] = counts_of(&recipe);
        println!("{name}: {lit} lit, {dark} dark, {between} between, {wrong} wrong");
        assert_eq!(wrong, 0, "{name}");
        assert!(lit > 1000 && dark > 150 && between < (lit + dark) / 2, "{name}: {lit} {dark} {between}");
        // A bias that ignores obstacles two bodies high, one that ignores none, and an inverted
        // map.
        for planted in [
            recipe.replace(bias, &bias.replace("2.0f *", "2000.0f *")),
            recipe.replace(bias, &bias.replace("2.0f *", "-2.0f *")),
            recipe.replace("seen.w < 0.0f || height <= bias", "seen.w < 0.0f || height > bias"),
        ] {
            let [.., wrong] = counts_of(&planted);
            println!("{name}, planted: {wrong} wrong");
            assert!(wrong > 100, "{name}: {wrong}");
        }
    }
}

/// In a shadow, a reflectance loses the light that falls on the point itself. Light that scatters
/// in from its surroundings remains, so nothing changes at and behind the terminator.
#[test]
fn a_reflectance_loses_what_fell_on_the_point_itself() {
    if !lapidary_testing::on_lavapipe("other drivers interpolate otherwise than the test does") {
        return;
    }
    let light = lights()[0].1;
    let scene = scene(light);
    let draw = |shadows: bool, rung: &str| {
        let settings = Settings { shadows, ..settings(rung) };
        render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered").linear
    };
    for rung in ["accurate", "table-257-r32f", "wrap"] {
        let [without, with] = [false, true].map(|shadows| draw(shadows, rung));
        let (mut taken, mut kept) = (0, 0);
        for Compared { found, cosine, full, seen, index } in compared(&scene, &light, &with) {
            let before = f64::from(without[index][0]);
            let expected = match seen {
                Seen::Lit => before,
                Seen::Dark => (before - cosine * full).max(0.0),
                Seen::Between if cosine <= 0.0 => before,
                Seen::Between => continue,
            };
            taken += usize::from(seen == Seen::Dark);
            kept += usize::from(cosine <= 0.0);
            assert!((found - expected).abs() < 1e-4 * full, "{rung} at {cosine}, {seen:?}: {found}, {expected}");
        }
        assert!(taken > 150 && kept > 300, "{rung}: {taken} {kept}");
    }
    // Lambert's law is the reflectance with a width of 0.
    assert_eq!(draw(true, "lambert"), draw(false, "lambert-shadowed"));
}

/// A clear ball over a table takes from the sun what Fresnel's law and Beer's law say of the straight way
/// through it.
#[test]
fn light_through_a_clear_ball_is_colored_by_its_way_inside() {
    const RADIUS: f32 = 8.0;
    let slate = Scene::named("vitrine").expect("built in").objects[0].material.clone();
    let color = Vec3::new(0.9, 0.3, 0.1);
    let clear = Material {
        base_color: Vec3::new(0.9, 1.0, 0.8),
        attenuation_color: color,
        attenuation_distance: RADIUS,
        ior: 1.5,
        ..Scene::named("octahedron").expect("built in").objects[0].material.clone()
    };
    let table = rounded_box(DVec3::new(40.0, 1.0, 40.0), 0.1, 2).placed(glam::DQuat::IDENTITY, -DVec3::Y);
    let place = DVec3::new(0.0, 20.0, 0.0);
    let ball = sphere(f64::from(RADIUS), 512).placed(glam::DQuat::IDENTITY, place);
    let toward = DVec3::new(0.3, 0.9, -0.2).normalize();
    let sun = Light::Directional { toward: toward.as_vec3(), irradiance: Vec3::splat(2.0) };
    let lamp_place = place + 60.0 * toward;
    let lamp = Light::Point { position: lamp_place.as_vec3(), intensity: Vec3::splat(8_000.0) };
    for light in [sun, lamp] {
        let camera = lapidary_scene::Camera::upright(Vec3::new(1.0, 90.0, 2.0), Vec3::ZERO, 0.8);
        let objects =
            vec![Object::new("table", table.clone(), slate.clone()), Object::new("ball", ball.clone(), clear.clone())];
        let scene = Scene { objects, lights: vec![light], camera, ..Scene::named("vitrine").expect("built in") };
        let draw = |without: &[Effect]| {
            let usual = settings("lambert");
            let without = usual.without.and(Effects::of(without));
            let settings = Settings { rung: Rung::ByMaterial, without, ..usual };
            render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered")
        };
        let [lit, shadowed] = [draw(&[Effect::ColoredShadow]), draw(&[])];
        let eye = scene.camera.eye.as_dvec3();
        let mut compared = 0;
        for (index, (direction, _)) in rays(&scene, &lit).into_iter().enumerate() {
            let point = eye - eye.y / direction.y * direction;
            let beside_eye = (place - eye).reject_from(direction).length();
            // Facets and texels blur the shadow's edge, where the way changes fast.
            let toward = light.arrival(point).direction;
            let aside = (place - point).reject_from(toward).length() / f64::from(RADIUS);
            if point.abs().max_element() > 39.0 || beside_eye < f64::from(RADIUS) || (0.93..1.03).contains(&aside) {
                continue;
            }
            let expected = if aside >= 1.0 { DVec3::ONE } else { through(aside, (&clear, f64::from(RADIUS))) };
            for channel in 0..3 {
                let found = f64::from(shadowed.linear[index][channel]) / f64::from(lit.linear[index][channel]);
                assert!(
                    (found - expected[channel]).abs() < 0.012,
                    "{light:?}, {aside} aside, channel {channel}: {found}, {expected}"
                );
            }
            compared += usize::from(aside < 1.0);
        }
        println!("{compared} pixels");
        assert!(compared > 300, "{compared}");
    }
}

/// A caster that is far away takes as much light from a scattering body as one that is near, beside its shadow's edge as in it.
#[test]
fn a_shadow_on_scattering_matter_is_the_same_from_near_and_far() {
    let skin = Scene::named("skin").expect("built in");
    let slate = Scene::named("vitrine").expect("built in").objects[0].material.clone();
    let medium = Medium {
        scattering: Vec3::splat(0.25),
        absorption: Vec3::splat(0.0025),
        anisotropy: 0.0,
        density: Density::Uniform,
    };
    let material = Material { medium: Some(medium), sigma0: None, ..skin.objects[0].material.clone() };
    let camera = lapidary_scene::Camera::upright(Vec3::new(0.0, 0.0, 200.0), Vec3::ZERO, 0.7);
    let sun = Light::Directional { toward: Vec3::Z, irradiance: Vec3::splat(PI as f32) };
    let drawn = |away: f64| {
        let ball = Object::new("ball", sphere(60.0, 256), material.clone());
        // A box over a part of the ball, behind the camera.
        let board = rounded_box(DVec3::new(60.0, 90.0, 2.0), 0.1, 2);
        let board =
            Object::new("board", board.placed(glam::DQuat::IDENTITY, DVec3::new(70.0, 0.0, away)), slate.clone());
        let scene = Scene { objects: vec![ball, board], lights: vec![sun], camera, ..skin.clone() };
        let settings = Settings { rung: Rung::ByMaterial, ..settings("drift") };
        render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered").linear
    };
    let [near, far] = [210.0, 400.0].map(drawn);
    let brightest = near.iter().map(|pixel| pixel[0]).fold(0.0, f32::max);
    let (mut dark, mut lit) = (0, 0);
    for (near, far) in near.iter().zip(&far).filter(|(near, _)| near[3] > 0.99) {
        assert!((near[0] - far[0]).abs() < 0.03 * brightest, "{near:?} {far:?}");
        dark += usize::from(near[0] < 0.1 * brightest);
        lit += usize::from(near[0] > 0.5 * brightest);
    }
    println!("{dark} dark, {lit} lit");
    assert!(dark > 1000 && lit > 1000, "{dark} {lit}");
}

/// Edges of each colour's width differ from those of one where colours spread differently, and light through thin parts only
/// adds.
#[test]
fn each_form_of_a_shadow_on_scattering_matter_draws_more_than_the_one_before() {
    let draw = |scene: &Scene, shadows: ShadowForm| {
        let usual = settings("drift");
        let diffuse = DiffuseOptions { shadows, ..usual.diffuse };
        let settings = Settings { half_space: true, shadows: true, diffuse, ..usual };
        render::render(lapidary_testing::gpu(), scene, &settings).expect("rendered").linear
    };
    let bunny = Scene::named("skin_bunny").expect("built in");
    let mut grey = bunny.clone();
    let material = &mut grey.objects[0].material;
    material.base_color = Vec3::splat(0.5);
    material.medium = Some(Medium::isotropic(Vec3::splat(0.9), Vec3::splat(0.1)));
    let most = |a: &[[f32; 4]], b: &[[f32; 4]], channel: usize| {
        a.iter().zip(b).map(|(a, b)| a[channel] - b[channel]).fold(0.0, f32::max)
    };
    // In grey matter all colours spread alike, so that both kinds of edges are one.
    let [soft, colors] = [ShadowForm::Soft, ShadowForm::Colors].map(|form| draw(&grey, form));
    assert!(furthest(&soft, &colors) < 1e-5, "{}", furthest(&soft, &colors));
    // In skin they are not, and light through thin parts only adds.
    let [soft, colors, through] = ShadowForm::ALL.map(|form| draw(&bunny, form));
    for channel in 0..3 {
        let difference = most(&soft, &colors, channel).max(most(&colors, &soft, channel));
        let (added, lost) = (most(&through, &colors, channel), most(&colors, &through, channel));
        println!("channel {channel}: soft and colors {difference:.3}, through adds {added:.3} and loses {lost:.1e}");
        assert!(difference > 0.005 && added > 0.01 && lost <= 0.0, "{channel}: {difference} {added} {lost}");
    }
}

/// Through a ball of scattering matter, lit from behind, comes what the slab's closed form says of the way inside: at its
/// middle, where the light's way is the diameter and enters head-on.
#[test]
fn light_comes_through_a_body_as_through_a_slab() {
    let skin = Scene::named("skin").expect("built in");
    let absorption = Vec3::new(0.004, 0.02, 0.05);
    let medium =
        Medium { scattering: Vec3::new(2.0, 1.6, 1.8), absorption, anisotropy: 0.0, density: Density::Uniform };
    let material = Material { medium: Some(medium), sigma0: None, ..skin.objects[0].material.clone() };
    let camera = lapidary_scene::Camera::upright(Vec3::new(0.0, 0.0, 200.0), Vec3::ZERO, 0.12);
    let sun = Light::Directional { toward: Vec3::NEG_Z, irradiance: Vec3::splat(PI as f32) };
    let lamp = Light::Point { position: Vec3::new(0.0, 0.0, -400.0), intensity: Vec3::splat(16e4 * PI as f32) };
    let path = lapidary_plan::thickness::free_path(&material).expect("a medium").to_array();
    let albedo = lapidary_plan::thickness::albedo(&material).expect("a medium");
    for (light, radius) in [(sun, 2.0f64), (sun, 6.0), (lamp, 2.0)] {
        let ball = Object::new("ball", sphere(radius, 256), material.clone());
        // A bead that stands in the light of one side calls for shadows.
        let aside = DVec3::new(0.8 * radius, 0.0, -2.0 * radius);
        let bead = sphere(0.1 * radius, 32).placed(glam::DQuat::IDENTITY, aside);
        let bead = Object::new("bead", bead, material.clone());
        let scene = Scene { objects: vec![ball, bead], lights: vec![light], camera, ..skin.clone() };
        let draw = |without: &[Effect]| {
            let usual = settings("drift");
            let without = usual.without.and(Effects::of(without));
            let settings = Settings { half_space: true, shadows: true, without, ..usual };
            render::render(lapidary_testing::gpu(), &scene, &settings).expect("rendered").linear
        };
        let middle = ((SIDE / 2) * SIDE + SIDE / 2) as usize;
        let [with, without] = [draw(&[]), draw(&[Effect::TranslucentShadow])].map(|picture| picture[middle]);
        // A lamp shines on the ball's far end, not on its centre.
        let irradiance = if light == sun { PI } else { 16e4 * PI / (400.0 + radius).powi(2) };
        for channel in 0..3 {
            let gamma = lapidary_half_space::gamma(albedo[channel], 0.0);
            let depth = 1.3 * 2.0 * radius as f32 / path[channel];
            let passed = lapidary_diffusion::slab(depth, gamma, lapidary_diffusion::DIFFUSION_MILNE);
            let expected = irradiance / PI * f64::from(passed * lapidary_half_space::exit(1.0, gamma));
            let found = f64::from(with[channel]);
            println!(
                "{light:?}, radius {radius}, channel {channel}: {found:.5}, {expected:.5}, {:.5}",
                without[channel]
            );
            // The filter takes in the ball around its far end, where the light falls aslant and its way is shorter: squares of
            // its width of half a mean free path, for two directions.
            let bent = 2.0 * (0.5 * f64::from(path[channel]) / radius).powi(2);
            assert!((found / expected - 1.0).abs() < 0.01 + bent, "{light:?} {radius} {channel}: {found} {expected}");
            assert!(f64::from(without[channel]) < 0.1 * found, "{radius} {channel}: {} {found}", without[channel]);
        }
    }
}

/// Returns the light that passes a ball straight on, at a distance from its centre in radii.
fn through(aside: f64, (material, radius): (&Material, f64)) -> DVec3 {
    let cosine = (1.0 - aside * aside).sqrt();
    let reflected = f64::from(lapidary_fresnel::dielectric(cosine as f32, material.ior));
    let way = 2.0 * radius * cosine / f64::from(material.attenuation_distance);
    let inside = material.attenuation_color.as_dvec3().powf(way) * material.base_color.as_dvec3();
    inside * (1.0 - reflected).powi(2)
}

/// Without lights there are no shadows, and clear stone casts none on the objects behind it.
#[test]
fn shadows_are_made_only_where_something_is_in_them() {
    use lapidary_render::plan::Plan;
    let light = lights()[0].1;
    let maps = |scene: &Scene, settings: &Settings| {
        let listing = Plan::of(scene, settings).expect("a plan").listing;
        listing.resources.iter().filter(|resource| resource.name.contains("for shadows")).count()
    };
    let asked = Settings { shadows: true, ..settings("accurate") };
    assert!(maps(&scene(light), &asked) > 0 && maps(&scene(light), &settings("accurate")) == 0);
    assert_eq!(maps(&Scene { lights: Vec::new(), ..scene(light) }, &asked), 0);
    assert_eq!(
        maps(&Scene::named("brilliant").expect("built in"), &Settings { shadows: true, ..settings("proxy-1") }),
        0
    );
}
