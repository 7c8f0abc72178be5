//! Images of materials in the recipe `cdrf_shading`, on a square that the camera faces: colour against the
//! texture's own lookup, and normals against the closed form of Lambert's law.

use glam::{Vec2, Vec3};
use lapidary_plan::{Effect, Effects};
use lapidary_render as render;
use lapidary_render::{Picture, Settings};
use lapidary_scene::surfaces::sphere;
use lapidary_scene::{Camera, Encoding, Light, Material, Mesh, Object, Scene, Texels, Texture, TextureTransform, Wrap};
use lapidary_testing::pixels::furthest;
use std::f32::consts::PI;
use std::sync::Arc;

const SIDE: u32 = 96;

/// A square from -1 to 1 that faces +z, with v down; u runs the other way if `mirrored`.
fn square(mirrored: bool) -> Mesh {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Vec2::from_array);
    Mesh {
        positions: corners.map(|corner| corner.extend(0.0)).into(),
        normals: vec![Vec3::Z; 4],
        uvs: corners.map(|corner| uv(corner, mirrored)).into(),
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    }
}

/// The texture coordinates at a place of the square.
fn uv(place: Vec2, mirrored: bool) -> Vec2 {
    let along = 0.5 + 0.5 * place;
    Vec2::new(if mirrored { 1.0 - along.x } else { along.x }, 1.0 - along.y)
}

fn scene(mesh: Mesh, material: Material, toward: Vec3) -> Scene {
    let mut scene = Scene::named("skin").expect("built in");
    scene.objects = vec![Object::new("square", mesh, material)];
    scene.lights = vec![Light::Directional { toward: toward.normalize(), irradiance: Vec3::splat(PI) }];
    // Its edges lie within the picture.
    scene.camera = Camera::upright(4.0 * Vec3::Z, Vec3::ZERO, 2.0 * (1.1f32 / 4.0).atan());
    scene
}

/// Draws by a rung, without environment and sheen.
fn draw(scene: &Scene, rung: &str) -> Picture {
    let without = Effects::of(&[Effect::Environment]).and(Effects::SHEEN);
    let rung = rung.parse().expect("a rung");
    let settings = Settings { rung, samples: 1, without, ..Settings::of_size(SIDE, SIDE) };
    render::render(lapidary_testing::gpu(), scene, &settings).expect("drawn")
}

/// Returns each pixel's place on the square, away from its edges, and its radiance.
fn pixels(picture: &Picture) -> Vec<(Vec2, Vec3)> {
    let place = |pixel: u32| 1.1 * ((pixel as f32 + 0.5) / (0.5 * SIDE as f32) - 1.0);
    let located = |(index, linear): (usize, &[f32; 4])| {
        let index = index as u32;
        (Vec2::new(place(index % SIDE), -place(index / SIDE)), Vec3::from_slice(&linear[..3]))
    };
    picture.linear.iter().enumerate().map(located).filter(|(place, _)| place.abs().max_element() < 0.97).collect()
}

fn matte() -> Material {
    Material { ior: 1.0, ..Material::standard() }
}

/// An image of 5 x 3 texels, no two alike.
fn patches(encoding: Encoding) -> Texture {
    let bytes = (0..5 * 3).flat_map(|place: u32| {
        [place * 83 % 251, place * 151 % 241, place * 199 % 239].map(|value| value as u8).into_iter().chain([255])
    });
    Texture::new(Arc::new(Texels::new(5, 3, bytes.collect()).expect("an image")), encoding)
}

/// A sampler may weight texels in steps of 1/256.
const WEIGHTS: f32 = 2.0 / 256.0;

#[test]
fn a_base_colour_is_the_textures_own_lookup() {
    let turned = TextureTransform { offset: Vec2::new(0.3, -0.2), rotation: 0.4, scale: Vec2::new(2.0, 1.5) };
    for (encoding, wrap, transform) in [
        (Encoding::Srgb, [Wrap::Repeat; 2], TextureTransform::IDENTITY),
        (Encoding::Linear, [Wrap::ClampToEdge, Wrap::MirroredRepeat], turned),
        (Encoding::Srgb, [Wrap::MirroredRepeat, Wrap::Repeat], turned),
    ] {
        let texture = Texture { wrap, transform, ..patches(encoding) };
        let factor = Vec3::new(0.9, 0.5, 1.0);
        let material = Material { base_color: factor, base_color_texture: Some(texture.clone()), ..matte() };
        let picture = draw(&scene(square(false), material, Vec3::Z), "lambert");
        let mut worst = 0.0f32;
        for (place, radiance) in pixels(&picture) {
            let expected = factor * texture.at(uv(place, false)).truncate();
            worst = worst.max((radiance - expected).abs().max_element());
        }
        println!("{encoding:?} {wrap:?}: {worst}");
        assert!(worst < 2.0 * WEIGHTS, "{encoding:?} {wrap:?}: {worst}");
    }
}

/// An image of one colour alone.
fn plain(texel: [u8; 4]) -> Texture {
    Texture::new(Arc::new(Texels::new(1, 1, texel.into()).expect("an image")), Encoding::Linear)
}

#[test]
fn a_normal_leans_along_u_and_against_v() {
    // Light from each side in turn; the tilt is (0.4, -0.2) over the code's range.
    let texel = [178u8, 102, 230, 255];
    let tilt = Vec3::from_array([0, 1, 2].map(|channel| 2.0 * f32::from(texel[channel]) / 255.0 - 1.0));
    let stretched = TextureTransform { scale: Vec2::new(6.0, 0.5), ..TextureTransform::IDENTITY };
    let identity = TextureTransform::IDENTITY;
    for (mirrored, scale, transform) in [
        (false, 1.0f32, identity),
        (true, 1.0, identity),
        (false, 2.5, identity),
        (false, -1.0, identity),
        // Slopes do not change with the number of texels that an image has.
        (false, 1.0, stretched),
    ] {
        let texture = Texture { transform, ..plain(texel) };
        let material = Material { normal_texture: Some(texture), normal_scale: scale, ..matte() };
        let leans = (tilt * Vec3::new(scale, scale, 1.0)).normalize();
        let normal = Vec3::new(if mirrored { -leans.x } else { leans.x }, leans.y, leans.z);
        for toward in [Vec3::Z, Vec3::new(1.0, 0.0, 1.0), Vec3::new(0.0, 1.0, 1.0), Vec3::new(-1.0, -1.0, 1.5)] {
            let picture = draw(&scene(square(mirrored), material.clone(), toward), "lambert");
            let expected = normal.dot(toward.normalize()).max(0.0);
            for (place, radiance) in pixels(&picture) {
                // Half floats hold x and y to 5e-4 of themselves.
                let off = (radiance - expected).abs().max_element();
                assert!(off < 1.5e-3, "{mirrored} {scale} {toward} {place}: {radiance} for {expected}");
            }
        }
    }
}

/// Waves along u, of which a wide red and a narrow blue are blurred away by different amounts.
#[test]
fn each_colour_has_the_slopes_that_its_light_leaves() {
    let texel = |column: u32| {
        let lean = 0.5 * (2.0 * PI * (column as f32 + 0.5) / 8.0).sin();
        [lean, 0.0, (1.0 - lean * lean).sqrt()].map(|part| ((0.5 * part + 0.5) * 255.0).round() as u8)
    };
    let bytes = (0..64 * 64).flat_map(|place| texel(place % 64).into_iter().chain([255])).collect();
    let waves = Texture::new(Arc::new(Texels::new(64, 64, bytes).expect("an image")), Encoding::Linear);
    // A texel is 2 / 64 wide.
    let sigma0 = Vec3::new(2.0, 1.0, 0.0) / 32.0;
    let material = Material { sigma0: Some(sigma0), normal_texture: Some(waves), ..matte() };
    let picture = draw(&scene(square(false), material, Vec3::new(1.0, 0.0, 1.0)), "accurate");
    let mut least = Vec3::INFINITY;
    let mut most = Vec3::NEG_INFINITY;
    for (_, radiance) in pixels(&picture) {
        (least, most) = (least.min(radiance), most.max(radiance));
    }
    let swing = most - least;
    let left = |width: f32| (-0.5 * (2.0 * PI * width / 8.0).powi(2)).exp();
    println!("{swing}, {} and {} of blue's", swing.x / swing.z, swing.y / swing.z);
    // The tilt's cosine bends a little, and a mean of unit vectors is shorter than one.
    for (found, expected) in [(swing.x / swing.z, left(2.0)), (swing.y / swing.z, left(1.0))] {
        assert!((found / expected - 1.0).abs() < 0.1, "{found} {expected}");
    }
}

#[test]
fn colours_of_vertices_run_straight_between_them() {
    let mut mesh = square(false);
    mesh.colors = [[0.0, 0.2, 1.0], [1.0, 0.2, 0.5], [1.0, 0.8, 0.0], [0.0, 0.8, 0.5]].map(Vec3::from_array).into();
    let picture = draw(&scene(mesh, matte(), Vec3::Z), "lambert");
    for (place, radiance) in pixels(&picture) {
        let share = 0.5 + 0.5 * place;
        let blue = 1.0 - 0.5 * share.x - 0.5 * share.y;
        let expected = Vec3::new(share.x, 0.2 + 0.6 * share.y, blue);
        assert!((radiance - expected).abs().max_element() < 1e-4, "{place}: {radiance} for {expected}");
    }
}

/// An image of one share is that share of every length by which light spreads: the ball is that of the scaled material.
/// With two shares, each side is.
#[test]
fn a_thickness_scales_how_far_light_spreads() {
    let image = |left: u8, right: u8| {
        let bytes = [[left; 64], [right; 64]].concat().into_iter().flat_map(|share| [7, share, 90, 255]).collect();
        Texture::new(Arc::new(Texels::new(128, 1, bytes).expect("an image")), Encoding::Linear)
    };
    for rung in ["accurate", "table-257-rgba16f", "power", "drift", "spherical"] {
        let mut ball = Scene::named("skin").expect("built in");
        ball.objects.truncate(1);
        ball.objects[0].mesh = sphere(8.0, 96);
        ball.objects[0].material.thickness = 20.0;
        let ball = ball.seen_from(80.0, 10.0);
        let with = |texture: Option<Texture>| {
            let mut scene = ball.clone();
            scene.objects[0].material.thickness_texture = texture;
            draw(&scene, rung).linear
        };
        let scaled = |share: f32| {
            let mut scene = ball.clone();
            let material = &mut scene.objects[0].material;
            material.sigma0 = material.sigma0.map(|sigma0| share * sigma0);
            let medium = material.medium.as_mut().expect("skin");
            (medium.scattering, medium.absorption) = (medium.scattering / share, medium.absorption / share);
            draw(&scene, rung).linear
        };
        let (half, thin, plain) = (scaled(128.0 / 255.0), scaled(32.0 / 255.0), with(None));
        // The table's step beside the widest sigma is 1/256.
        let most = if rung.starts_with("table") { 2e-3 } else { 2e-5 };
        assert_eq!(with(Some(image(255, 255))), plain, "{rung}");
        let found = furthest(&with(Some(image(128, 128))), &half);
        let difference = furthest(&half, &plain).min(furthest(&half, &thin));
        println!("{rung}: {found:.1e} off where the share makes {difference:.3}");
        assert!(found < most && difference > 0.02, "{rung}: {found} {difference}");
        // Around the ball u runs once: a pixel is of one share or of the other, but for a texel's width between them.
        let both = with(Some(image(128, 32)));
        let like = |other: &[[f32; 4]]| {
            let is_like = |(a, b): &(&[f32; 4], &[f32; 4])| (0..3).all(|k| (a[k] - b[k]).abs() < most);
            both.iter().zip(other).filter(is_like).count()
        };
        let covered = both.iter().filter(|pixel| pixel[3] > 0.0).count();
        let (beside, of_half, of_thin) = (both.len() - covered, like(&half), like(&thin));
        assert!(of_half + of_thin > 2 * beside + covered * 95 / 100, "{rung}: {of_half} {of_thin} of {covered}");
        // Seen from an azimuth of 10 degrees, 41 % of the disc is the smaller side.
        assert!(of_half.min(of_thin) > beside + covered * 35 / 100, "{rung}: {of_half} {of_thin} of {covered}");
        // Nothing spreads where the share is 0.
        let lambert = draw(&ball, "lambert").linear;
        assert!(furthest(&with(Some(image(0, 0))), &lambert) < most, "{rung}");
    }
}

/// What does not enter is reflected by Lambert's law, by the factor and by the image's alpha alike, and light that is spread
/// is the rest.
#[test]
fn a_transmission_is_the_share_that_enters() {
    if !lapidary_testing::on_lavapipe("other drivers round each variant differently") {
        return;
    }
    let image = |share: u8| {
        let texels = Texels::new(1, 1, vec![255, 9, 90, share]).expect("an image");
        Texture::new(Arc::new(texels), Encoding::Linear)
    };
    let mut ball = Scene::named("skin").expect("built in");
    ball.objects.truncate(1);
    ball.objects[0].mesh = sphere(8.0, 96);
    let ball = ball.seen_from(80.0, 10.0);
    for rung in ["accurate", "table-257-rgba16f", "power", "drift"] {
        let with = |factor: f32, texture: Option<Texture>| {
            let mut scene = ball.clone();
            scene.objects[0].material.diffuse_transmission = factor;
            scene.objects[0].material.diffuse_transmission_texture = texture;
            draw(&scene, rung).linear
        };
        let (whole, lambert) = (with(1.0, None), draw(&ball, "lambert").linear);
        assert_eq!(with(1.0, Some(image(255))), whole, "{rung}");
        let difference = furthest(&whole, &lambert);
        let mixed = |share: f32| -> Vec<[f32; 4]> {
            let mix = |(a, b): (&[f32; 4], &[f32; 4])| std::array::from_fn(|k| share * a[k] + (1.0 - share) * b[k]);
            whole.iter().zip(&lambert).map(mix).collect()
        };
        for (factor, code) in [(0.25, 255u8), (1.0, 64), (0.5, 128), (1.0, 0)] {
            let share = factor * f32::from(code) / 255.0;
            let found = furthest(&with(factor, Some(image(code))), &mixed(share));
            println!("{rung}, {factor} of {code}: {found:.1e} off where the share makes {difference:.3}");
            // The picture's half floats.
            assert!(found < 1e-3 && difference > 0.05, "{rung} {factor} {code}: {found} {difference}");
        }
        assert!(furthest(&with(0.25, None), &mixed(0.25)) < 1e-3, "{rung}");
    }
}

/// A texel that covers many texels of the image shows their mean, which lies at a level of its own; one that lies between
/// them would show any.
#[test]
fn a_small_picture_of_a_large_image_is_its_mean() {
    let bytes = (0..1024 * 1024u32).flat_map(|place| {
        let white = (place % 1024 + place / 1024) % 2 == 0;
        [if white { 255 } else { 0 }, 128, 64, 255]
    });
    let texels = Texels::new(1024, 1024, bytes.collect()).expect("an image");
    let texture = Texture::new(Arc::new(texels), Encoding::Linear);
    let material = Material { base_color_texture: Some(texture), ..matte() };
    let picture = draw(&scene(square(false), material, Vec3::Z), "lambert");
    let mut worst = 0.0f32;
    for (_, radiance) in pixels(&picture) {
        worst = worst.max((radiance - Vec3::new(127.5, 128.0, 64.0) / 255.0).abs().max_element());
    }
    println!("{worst}");
    // A level is rounded to eight bits.
    assert!(worst < 1.0 / 255.0, "{worst}");
}

/// Two bodies and three slots that use one image share one texture of the frame, and those that take its bytes for colours
/// another one.
#[test]
fn an_image_is_uploaded_once() {
    let texels = patches(Encoding::Linear).texels;
    let texture_of = |encoding: Encoding| Some(Texture::new(Arc::clone(&texels), encoding));
    let mut scene = Scene::named("skin").expect("built in");
    scene.objects.truncate(1);
    let material = &mut scene.objects[0].material;
    (material.thickness, material.diffuse_transmission) = (20.0, 1.0);
    material.thickness_texture = texture_of(Encoding::Linear);
    material.diffuse_transmission_texture = texture_of(Encoding::Linear);
    material.base_color_texture = texture_of(Encoding::Srgb);
    let mut other = scene.objects[0].clone();
    other.name = "other".to_owned();
    scene.objects.push(other);
    let rung = "accurate".parse().expect("a rung");
    let plan = render::plan::Plan::of(&scene, &Settings { rung, ..Settings::of_size(SIDE, SIDE) }).expect("a plan");
    let images: Vec<&str> =
        plan.frame.resources.iter().map(|one| &*one.name).filter(|name| name.ends_with("image")).collect();
    assert_eq!(images, ["base colour image", "thickness image"]);
}

/// What is drawn by its factor alone is said.
#[test]
fn a_stone_with_an_image_is_told_that_its_factor_is_drawn() {
    let mut stone = Scene::named("brilliant").expect("built in");
    stone.objects[0].material.base_color_texture = Some(patches(Encoding::Srgb));
    stone.objects[0].material.thickness_texture = Some(patches(Encoding::Linear));
    let settings = Settings::of_size(SIDE, SIDE);
    let plan = render::plan::Plan::of(&stone, &settings).expect("a plan");
    let said: Vec<String> = plan.notes.iter().map(ToString::to_string).collect();
    assert!(said.iter().any(|line| line.contains("does not draw baseColorTexture,")), "{said:?}");
}
