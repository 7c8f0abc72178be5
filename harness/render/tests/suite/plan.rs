//! Plans list everything that is drawn. Nothing exists that the scene does not need.

use glam::Vec3;
use lapidary_plan::{Effect, Effects, Outside, Quality, Technique};
use lapidary_render as render;
use lapidary_render::frame::Executor;
use lapidary_render::plan::{Listing, Plan, Resource};
use lapidary_render::{Curvature, DiffuseOptions, GemOptions, Settings};
use lapidary_scene::environment_map::EnvironmentMap;
use lapidary_scene::light::Light;
use lapidary_scene::{Copies, Coverage, Density, Encoding, Environment, Material, Object, Place, Scene, Texture};
use lapidary_testing::gpu;
use std::collections::BTreeSet;

fn settings() -> Settings {
    Settings { samples: 1, rung: lapidary_plan::Rung::ByMaterial, ..Settings::of_size(32, 24) }
}

fn of_rung(rung: &str) -> Settings {
    Settings { rung: rung.parse().expect(rung), ..settings() }
}

/// Returns the listing of everything that is made and run on the real device.
fn drawn(scene: &Scene, settings: &Settings) -> Listing {
    let executor = render::frame(Some(gpu()), scene, settings).map(|frame| Executor::new(gpu(), frame).expect("made"));
    let executor = executor.unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    executor.run(|_, _| {}).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    Listing::of(executor.frame())
}

/// Nothing else creates device objects, so the listing is complete.
#[test]
fn the_executor_alone_makes_things_of_a_device() {
    let sources = concat!(env!("CARGO_MANIFEST_DIR"), "/../render/src");
    let mut makers = Vec::new();
    let mut folders = vec![std::path::PathBuf::from(sources)];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if std::fs::read_to_string(&path).expect("a source").contains("device.create_") {
                makers.push(path.strip_prefix(sources).expect("within").to_owned());
            }
        }
    }
    assert_eq!(makers, [std::path::Path::new("frame/execute.rs")]);
}

fn planned(scene: &Scene, settings: &Settings) -> Listing {
    Plan::of(scene, settings).unwrap_or_else(|error| panic!("{}: {error}", scene.name)).listing
}

fn named(name: &str) -> Scene {
    Scene::named(name).expect("built in")
}

/// Returns a small image of a sky.
fn sky() -> Environment {
    let pixels = (0..8 * 4).map(|pixel| [0.1 * (pixel % 5) as f32, 0.5, 1.0, 1.0]).collect();
    Environment::Map(EnvironmentMap { width: 8, height: 4, pixels })
}

#[test]
fn what_is_drawn_is_what_was_planned() {
    let mapped = Settings { environment: sky(), ..settings() };
    let deferred = Settings { gem: GemOptions { deferred: true, ..GemOptions::default() }, ..settings() };
    let cases = [
        ("brilliant", settings()),
        ("ruby", mapped.clone()),
        ("prism_chain", deferred),
        ("brilliant", of_rung("convex-8+3")),
        ("bunny_stone", of_rung("bvh-2")),
        ("wax", settings()),
        ("skin_ring", of_rung("blur")),
        ("skin_bunny", of_rung("lambert-shadowed")),
        ("vitrine", Settings { shadows: true, ..settings() }),
        ("jade", Settings { environment: sky(), ..of_rung("table-256-rgba8") }),
        ("dragon", of_rung("tiled-26-32")),
        ("bunny", of_rung("paper-16")),
    ];
    for (name, settings) in cases {
        let scene = named(name);
        let (drawn, planned) = (drawn(&scene, &settings), planned(&scene, &settings));
        assert_eq!(drawn, planned, "{name} by {}", settings.rung);
        assert!(!drawn.steps.is_empty() && !drawn.resources.is_empty() && !drawn.pipelines.is_empty(), "{name}");
        let unnamed = drawn.resources.iter().find(|resource| resource.name.ends_with("unnamed"));
        assert_eq!(unnamed, None, "{name}: every resource has a name");
        for step in &drawn.steps {
            assert!(!step.pass.is_empty(), "{name}: {step:?} has no pass");
            assert!(drawn.pipelines.iter().any(|pipeline| pipeline.name == step.pipeline), "{name}: {step:?}");
            for resource in &step.resources {
                assert!(drawn.resource(resource).is_some(), "{name}: {step:?} binds what was not made");
            }
        }
    }
}

fn names(listing: &Listing) -> BTreeSet<&str> {
    listing.resources.iter().map(|resource| resource.name.as_str()).collect()
}

/// Returns the recipe and the entry points of each pipeline.
fn compiled(listing: &Listing) -> BTreeSet<(&str, &[String])> {
    listing.pipelines.iter().map(|pipeline| (pipeline.recipe.as_str(), &pipeline.entries[..])).collect()
}

fn passes(listing: &Listing) -> BTreeSet<&str> {
    listing.steps.iter().map(|step| step.pass.as_str()).collect()
}

/// Effect in a scene that needs it, and the items that disappear with it.
struct Case {
    effect: Effect,
    scene: Scene,
    settings: Settings,
    /// Names of resources (without the object's name), recipes and passes.
    goes: [Vec<&'static str>; 3],
}

/// Returns a built-in scene with its first body alone.
fn one(name: &str) -> Scene {
    let scene = named(name);
    Scene { objects: scene.objects[..1].to_vec(), ..scene }
}

/// Returns the vitrine with only its table and one body on it.
fn behind(body: &str) -> Scene {
    let mut scene = named("vitrine");
    scene.objects.retain(|object| object.name == "table" || object.name == body);
    scene
}

fn cases() -> Vec<Case> {
    let none = || [vec![], vec![], vec![]];
    let of_cells = vec![
        "cells",
        "columns crossed beyond",
        "conductances",
        "conductances of level 1",
        "conductances of level 2",
        "densities",
        "filled eighths",
        "fluence of level 0",
        "fluence of level 1",
        "fluence of level 2",
        "fluence to look up",
        "grid",
        "grid of densities",
        "large triangles",
        "large triangles of cells",
        "level",
        "light that enters",
        "loads",
        "losses",
        "losses of level 1",
        "losses of level 2",
        "matter",
        "no tiles",
        "nodes",
        "right side of level 0",
        "right side of level 1",
        "residuals",
        "right side of level 2",
        "source",
        "surfaces in voxels",
        "tile count of level 0",
        "tile count of level 1",
        "tile count of level 2",
        "tiles left to solve of level 0",
        "tiles left to solve of level 1",
        "tiles left to solve of level 2",
        "tiles of level 0",
        "tiles of level 1",
        "tiles of level 2",
        "veins",
        "vertices in the grid",
        "voxel counts",
    ];
    let of_voxels = vec![
        "grid",
        "columns crossed beyond",
        "large triangles",
        "vertices in the grid",
        "matter",
        "surface voxels",
        "voxel counts",
        "grid of densities",
        "veins",
        "densities",
        "fresh progress",
        "progress",
        "workgroups",
        "matter of tiles",
        "listed tiles",
        "lists of tiles",
        "kept progress",
        "costs of red",
        "costs of green",
        "costs of blue",
        "seeding of red",
        "seeding of green",
        "seeding of blue",
        "solve",
    ];
    let spot = Light::Spot {
        position: Vec3::new(0.0, 200.0, 0.0),
        direction: Vec3::NEG_Y,
        intensity: Vec3::splat(1e4),
        inner_angle: 0.2,
        outer_angle: 0.5,
    };
    let spotlit = Scene { lights: vec![spot], ..one("wax") };
    let mut coloured = one("wax");
    coloured.objects[0].mesh.colors = vec![Vec3::ONE; coloured.objects[0].mesh.positions.len()];
    let mut thick = one("head");
    thick.objects[0].material.thickness = 1.0;
    let shares = |texture: Texture| Texture { encoding: Encoding::Linear, ..texture };
    thick.objects[0].material.thickness_texture = thick.objects[0].material.base_color_texture.clone().map(shares);
    // Half of each is a metal: the rest still sends light of the environment back.
    let metal = Material { metallic: 0.5, roughness: 0.5, ..Material::standard() };
    let gilded = with_material("wax", |_| metal.clone());
    let mut engraved = with_material("head", |_| metal.clone());
    engraved.objects[0].material.metallic_roughness_texture = thick.objects[0].material.thickness_texture.clone();
    let mut lantern = one("wax");
    let position = lantern.bounds().centre();
    lantern.lights.push(Light::Point { position, intensity: Vec3::ONE });
    let mut partial = one("head");
    partial.objects[0].material.diffuse_transmission = 0.5;
    let mut inlaid = partial.clone();
    inlaid.objects[0].material.diffuse_transmission_texture = thick.objects[0].material.thickness_texture.clone();
    let mut thin = one("brilliant");
    thin.objects[0].material.thickness = 0.0;
    let mut copied = one("octahedron");
    let Object { name, mesh, material, .. } = copied.objects.remove(0);
    let copies = Copies { shape: mesh, places: vec![Place::IDENTITY] };
    copied.objects.push(Object::of_copies(name, copies, material));
    // A clear body within a clear one, and a pearl within both.
    let mut pearl = one("octahedron");
    for (scale, material) in [(0.5, pearl.objects[0].material.clone()), (0.2, Material::standard())] {
        let mut mesh = pearl.objects[0].mesh.clone();
        mesh.positions.iter_mut().for_each(|position| *position *= scale);
        pearl.objects.push(Object::new("inner", mesh, material));
    }
    let clear = Scene { objects: pearl.objects[..2].to_vec(), ..pearl.clone() };
    let mut round = one("octahedron");
    round.objects[0].mesh = lapidary_scene::surfaces::sphere(1.0, 24);
    let mut sheer = one("octahedron");
    let coverage = Some(Coverage { share: 0.5, cutoff: None });
    sheer.objects[0].material = Material { coverage, ..Material::standard() };
    let mut frosted = one("octahedron");
    frosted.objects[0].material.roughness = 0.5;
    let sun = Light::Directional { toward: Vec3::Y, irradiance: Vec3::ONE };
    let lit = Scene { lights: vec![sun], ..one("brilliant") };
    let tiled = || of_rung("tiled-6-16");
    let case = |effect, scene, settings, goes| Case { effect, scene, settings, goes };
    vec![
        case(Effect::ProxyGeometry, one("brilliant"), of_rung("proxy-2"), [vec!["normals"], vec![], vec![]]),
        case(Effect::ConvexTrace, one("brilliant"), of_rung("convex-2"), none()),
        case(Effect::BvhTrace, one("brilliant"), of_rung("bvh-2"), [vec!["nodes"], vec![], vec![]]),
        case(Effect::ThinWall, thin, settings(), none()),
        case(Effect::Absorption, one("ruby"), settings(), none()),
        case(Effect::Dispersion, one("brilliant"), of_rung("proxy-2+3"), [vec!["wavelengths"], vec![], vec![]]),
        case(Effect::Instances, copied, of_rung("bvh-2"), [vec!["instances"], vec![], vec![]]),
        case(
            Effect::Footprint,
            one("brilliant"),
            Settings { gem: GemOptions { footprint: true, ..GemOptions::default() }, ..of_rung("walk-2") },
            [vec!["radiance", "neighbours", "resolve's view"], vec!["gem_resolve", "gem_walk"], vec!["gem_resolve"]],
        ),
        case(
            Effect::ScreenTrace,
            named("tray"),
            Settings {
                gem: GemOptions { outside: Some(Outside::Screen), ..GemOptions::default() },
                ..of_rung("by-material")
            },
            [
                vec!["screen's radiance", "screen's depth", "screen's view", "copy's view"],
                vec!["screen_copy"],
                vec!["screen_copy", "stones"],
            ],
        ),
        case(
            Effect::BoundsTrace,
            named("tray"),
            Settings {
                gem: GemOptions { outside: Some(Outside::Bodies), ..GemOptions::default() },
                ..of_rung("by-material")
            },
            [vec!["bodies"], vec![], vec![]],
        ),
        case(Effect::Nested, pearl.clone(), of_rung("scene-4"), none()),
        case(Effect::Behind, clear, of_rung("scene-4"), none()),
        case(Effect::Around, pearl, of_rung("scene-4"), [vec!["corner normals"], vec![], vec![]]),
        case(Effect::Smooth, round, of_rung("scene-4"), [vec!["corner normals"], vec![], vec![]]),
        case(Effect::Rough, frosted, of_rung("scene-4"), none()),
        case(Effect::Light, lit, settings(), [vec!["lights", "glints"], vec![], vec![]]),
        case(
            Effect::Cdrf,
            one("wax"),
            Settings {
                diffuse: DiffuseOptions { curvature: Curvature::Vertex, ..DiffuseOptions::default() },
                ..of_rung("table-256-rgba8")
            },
            [vec!["table", "table sampler", "curvatures"], vec![], vec![]],
        ),
        case(
            Effect::TextureDiffusion,
            one("wax"),
            of_rung("blur"),
            [
                vec![
                    "uvs",
                    "indices with halos",
                    "texture sampler",
                    "irradiance",
                    "stretch",
                    "diffused irradiance",
                    "taps",
                    "diffused sampler",
                ],
                vec!["texture_irradiance", "blur_texture"],
                vec!["texture_irradiance", "blur_texture"],
            ],
        ),
        // By itself it takes none of what the spread of light takes.
        case(
            Effect::HalfSpace,
            one("wax"),
            Settings {
                half_space: true,
                without: Effects::of(&[Effect::Cdrf, Effect::Environment]).and(Effects::SHEEN),
                ..of_rung("accurate")
            },
            none(),
        ),
        case(
            Effect::OpticalPath,
            one("dragon"),
            tiled(),
            [
                of_voxels,
                vec!["voxelize", "optical_path_density", "optical_path_seed", "optical_path_tiles"],
                vec!["voxelize", "densities", "seeds", "solve"],
            ],
        ),
        case(
            Effect::Diffusion,
            one("dragon"),
            of_rung("diffusion-16"),
            [
                of_cells,
                vec!["voxelize", "optical_path_density", "diffusion_cells", "diffusion_source", "diffusion_solve"],
                vec!["voxelize", "densities", "diffusion_cells", "diffusion_source", "diffusion_solve"],
            ],
        ),
        case(
            Effect::LampInside,
            lantern,
            of_rung("diffusion-16"),
            [vec!["lamps inside"], vec!["diffusion_source"], vec![]],
        ),
        case(Effect::Surface, one("bunny"), tiled(), [vec!["surface voxels"], vec![], vec![]]),
        case(
            Effect::Color,
            one("bunny"),
            tiled(),
            [vec!["costs of green", "costs of blue", "seeding of green", "seeding of blue"], vec![], vec![]],
        ),
        case(
            Effect::ExtinctionPerVoxel,
            one("dragon"),
            tiled(),
            [vec!["grid of densities", "veins", "densities"], vec!["optical_path_density"], vec!["densities"]],
        ),
        case(
            Effect::Shadow,
            one("wax_bunny"),
            of_rung("lambert-shadowed"),
            [
                vec![
                    "view of a light",
                    "views of lights",
                    "reflective shadow maps for shadows",
                    "depth of maps for shadows",
                ],
                vec!["draw_light_map"],
                vec!["draw_light_map"],
            ],
        ),
        case(
            Effect::TranslucentShadow,
            one("wax_bunny"),
            Settings { half_space: true, shadows: true, ..of_rung("drift") },
            none(),
        ),
        case(
            Effect::ColoredShadow,
            behind("ruby"),
            settings(),
            [
                vec!["stone in the light", "view of a light", "views of lights", "shadows of clear stones"],
                vec!["colored_shadow"],
                vec!["colored_shadow"],
            ],
        ),
        case(Effect::Environment, one("wax"), of_rung("accurate"), [vec!["harmonics"], vec![], vec![]]),
        case(Effect::Dielectric, one("wax_bunny"), of_rung("diffusion-16"), none()),
        case(
            Effect::EnvironmentMap,
            one("brilliant"),
            Settings { environment: sky(), ..settings() },
            [vec!["environment map"], vec![], vec![]],
        ),
        case(
            Effect::BaseColorTexture,
            one("head"),
            of_rung("accurate"),
            [vec!["base colour image", "base colour image's sampler"], vec![], vec![]],
        ),
        case(
            Effect::NormalTexture,
            one("head"),
            of_rung("accurate"),
            [vec!["normals by image", "normal image's sampler"], vec![], vec![]],
        ),
        case(
            Effect::RoughnessTexture,
            engraved,
            of_rung("lambert"),
            [vec!["roughness image", "roughness image's sampler", "uvs"], vec![], vec![]],
        ),
        case(
            Effect::ThicknessTexture,
            thick,
            of_rung("accurate"),
            [vec!["thickness image", "thickness image's sampler"], vec![], vec![]],
        ),
        case(Effect::PartialTransmission, partial, of_rung("accurate"), none()),
        case(
            Effect::TransmissionTexture,
            inlaid,
            of_rung("accurate"),
            [vec!["transmission image", "transmission image's sampler"], vec![], vec![]],
        ),
        case(Effect::VertexColor, coloured, of_rung("accurate"), [vec!["colors"], vec![], vec![]]),
        case(Effect::Coverage, sheer, of_rung("lambert"), none()),
        case(Effect::Microfacet, one("wax"), of_rung("accurate"), none()),
        case(Effect::SecondLobe, one("head"), of_rung("accurate"), none()),
        case(
            Effect::Reflection,
            one("jade"),
            Settings { environment: sky(), ..of_rung("accurate") },
            [vec!["environment map"], vec![], vec![]],
        ),
        case(
            Effect::Metal,
            gilded,
            of_rung("lambert"),
            [vec!["blurred environment", "blurred environment's sampler", "metal's reflectance"], vec![], vec![]],
        ),
        case(Effect::Spot, spotlit, of_rung("accurate"), none()),
    ]
}

#[test]
fn an_effect_that_is_left_out_leaves_nothing_behind() {
    let cases = cases();
    let covered: Vec<Effect> = cases.iter().map(|case| case.effect).collect();
    assert_eq!(covered, Effect::ALL, "every effect once");
    for Case { effect, scene, settings, goes } in lapidary_testing::sampled(cases, 3) {
        let on = drawn(&scene, &settings);
        let without = settings.without.and(Effects::of(&[effect]));
        let off = drawn(&scene, &Settings { without, ..settings.clone() });
        let [resources, recipes, gone_passes] = goes;
        // The listings differ in exactly the effect's own items.
        let short = |name: &str| name.rsplit('/').next().unwrap_or_default().to_owned();
        let gone: BTreeSet<String> = names(&on).difference(&names(&off)).map(|name| short(name)).collect();
        assert_eq!(gone, resources.iter().map(|name| (*name).to_owned()).collect(), "{effect}: resources");
        assert_eq!(names(&off).difference(&names(&on)).next(), None, "{effect}: nothing comes for what goes");
        let gone: BTreeSet<&str> = compiled(&on).difference(&compiled(&off)).map(|(recipe, _)| *recipe).collect();
        assert_eq!(gone, recipes.into_iter().collect(), "{effect}: recipes");
        let gone: BTreeSet<&str> = passes(&on).difference(&passes(&off)).copied().collect();
        assert_eq!(gone, gone_passes.into_iter().collect(), "{effect}: passes");
        // The remaining pipelines are compiled without the effect, and are smaller than with it.
        let value = |listing: &Listing, value: f64| {
            let name = effect.override_name();
            let overrides = listing.pipelines.iter().flat_map(|pipeline| &pipeline.overrides);
            overrides.filter(|(known, set)| known == name && *set == value).count()
        };
        assert!(value(&on, 1.0) > 0 && value(&off, 1.0) == 0, "{effect}: compiled with {}", value(&off, 1.0));
        let instructions = |listing: &Listing| -> usize { listing.pipelines.iter().map(|p| p.instructions).sum() };
        // Without bodies behind, a few instructions ask whether a ray is within one, and save a search.
        let most = instructions(&on) + if effect == Effect::Behind { 8 } else { 0 };
        assert!(instructions(&off) < most, "{effect}: {} of {most}", instructions(&off));
        assert!(off.bytes() <= on.bytes(), "{effect}");
    }
}

#[test]
fn a_materials_variant_runs_on_its_own_draw_alone() {
    let [mut diamond, ruby] = ["brilliant", "ruby"].map(named);
    diamond.objects.extend(ruby.objects);
    // In the view the one overlaps the other, which they would be drawn together for.
    let settings = Settings { without: Effects::of(&[Effect::Nested, Effect::Behind]), ..settings() };
    let listing = drawn(&diamond, &settings);
    let effects = |object: &str| {
        let steps: Vec<_> = listing.steps.iter().filter(|step| step.object == object).collect();
        let [step] = steps[..] else { panic!("{object}: {steps:?}") };
        let pipeline = listing.pipelines.iter().find(|pipeline| pipeline.name == step.pipeline).expect("compiled");
        let on = pipeline.overrides.iter().filter(|(name, value)| name.starts_with("EFFECT_") && *value == 1.0);
        on.map(|(name, _)| name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(effects("brilliant"), ["EFFECT_CONVEX_TRACE", "EFFECT_DISPERSION"]);
    assert_eq!(effects("ruby"), ["EFFECT_CONVEX_TRACE", "EFFECT_ABSORPTION", "EFFECT_DISPERSION"]);
}

/// Returns the reason why an effect is off.
fn off(scene: &Scene, settings: &Settings, effect: Effect) -> String {
    let plan = Plan::of(scene, settings).expect("a plan");
    let decisions = &plan.objects[0].decisions.effects;
    let decision = decisions.iter().find(|decision| decision.effect == effect).expect("every effect");
    assert!(!decision.on, "{effect}: {}", decision.reason);
    decision.reason.clone()
}

fn with_material(name: &str, change: impl Fn(&Material) -> Material) -> Scene {
    let scene = one(name);
    let objects = scene.objects.iter().map(|object| Object { material: change(&object.material), ..object.clone() });
    Scene { objects: objects.collect(), ..scene.clone() }
}

#[test]
fn what_is_off_says_why() {
    let settings = settings();
    assert_eq!(off(&one("brilliant"), &settings, Effect::Absorption), "attenuation white");
    assert_eq!(off(&one("prism"), &settings, Effect::Cdrf), "nothing inside scatters");
    let plain =
        with_material("ruby", |material| Material { dispersion: lapidary_scene::Dispersion::None, ..material.clone() });
    assert_eq!(off(&plain, &settings, Effect::Dispersion), "dispersion 0");
    let thin = with_material("ruby", |material| Material { thickness: 0.0, ..material.clone() });
    for effect in [Effect::ConvexTrace, Effect::Absorption, Effect::Dispersion] {
        assert_eq!(off(&thin, &settings, effect), "thickness 0");
    }
    let endless = with_material("ruby", |m| Material { attenuation_distance: f32::INFINITY, ..m.clone() });
    assert_eq!(off(&endless, &settings, Effect::Absorption), "attenuation distance infinite");
    let opaque = with_material("ruby", |material| Material { transmission: 0.0, ..material.clone() });
    assert_eq!(off(&opaque, &settings, Effect::ProxyGeometry), "transmission 0: opaque");
    let matched = with_material("wax", |material| Material { ior: 1.0, ..material.clone() });
    assert_eq!(off(&matched, &settings, Effect::Microfacet), "ior 1: nothing reflects");
    let unlit = Scene { lights: Vec::new(), ..one("bunny") };
    assert_eq!(
        off(&unlit, &of_rung("godunov-16"), Effect::OpticalPath),
        "no light but the environment, which goes no way through bodies"
    );
    let dark = Settings { without: Effects::of(&[Effect::Environment]), ..of_rung("diffusion-16") };
    assert_eq!(off(&unlit, &dark, Effect::Diffusion), "no light");
    assert_eq!(off(&matched, &of_rung("diffusion-16"), Effect::Dielectric), "ior 1: nothing reflects");
    assert_eq!(off(&one("bunny"), &settings, Effect::ExtinctionPerVoxel), "density the same everywhere");
    assert_eq!(off(&one("bunny"), &of_rung("diffusion-16"), Effect::LampInside), "no lamp stands inside");
    let mut grey = one("bunny");
    for medium in grey.objects.iter_mut().filter_map(|object| object.material.medium.as_mut()) {
        medium.scattering = Vec3::splat(2.0);
        medium.absorption = Vec3::splat(0.01);
        medium.density = Density::Uniform;
    }
    assert_eq!(off(&grey, &of_rung("godunov-16"), Effect::Color), "scattering, absorption and lights are grey");
    // A body with only flat facets has no curvature.
    let mut flat = one("wax");
    let mesh = named("octahedron").objects.remove(0).mesh;
    let positions = mesh.indices.iter().map(|index| mesh.positions[*index as usize]).collect::<Vec<_>>();
    let normals = positions.chunks_exact(3).flat_map(|t| [(t[1] - t[0]).cross(t[2] - t[0]).normalize(); 3]).collect();
    let indices = (0..positions.len() as u32).collect();
    flat.objects[0].mesh = lapidary_scene::Mesh { positions, normals, indices, ..Default::default() };
    assert_eq!(off(&flat, &of_rung("accurate"), Effect::Cdrf), "curvature everywhere 0");
    let left_out = Settings { without: Effects::of(&[Effect::Dispersion]), ..settings.clone() };
    let reason = off(&one("brilliant"), &left_out, Effect::Dispersion);
    assert_eq!(reason, "left out on request, though Sellmeier equation of diamond (V_d 55.3)");
}

/// Resources by name and bytes, pipelines by the inputs of their compilation, steps by their
/// contents.
type Parts = (BTreeSet<Resource>, BTreeSet<String>, BTreeSet<String>);

fn parts(scene: &Scene) -> Parts {
    // What leaves a stone meets no other body, and no body casts a shadow: with others beside it, a
    // body takes more.
    let options = GemOptions { outside: Some(Outside::Environment), ..GemOptions::default() };
    let without = Effects::of(&[Effect::Shadow, Effect::ColoredShadow]);
    let listing = planned(scene, &Settings { gem: options, without, ..settings() });
    // Pipelines are numbered in the order of their creation, so they are compared by contents.
    let key = |name: &str| {
        let pipeline = listing.pipelines.iter().find(|pipeline| pipeline.name == name);
        pipeline.map(|p| format!("{} {:?} {:?} {}", p.recipe, p.entries, p.overrides, p.instructions))
    };
    let steps = listing.steps.iter().map(|step| {
        format!("{} {} {:?} {:?} x {}", step.pass, step.object, key(&step.pipeline), step.resources, step.times)
    });
    let pipelines = listing.pipelines.iter().filter_map(|pipeline| key(&pipeline.name));
    (listing.resources.iter().cloned().collect(), pipelines.collect(), steps.collect())
}

/// A set of objects takes the parts that each object takes alone, and no others. Removing an object
/// thus removes exactly the parts that no other object needs.
#[test]
fn every_subset_of_the_vitrine_takes_what_its_objects_take() {
    let vitrine = named("vitrine");
    // Bodies that come and go together: the two that share the light's maps, whose size follows from all of them, and the
    // parts of the stand.
    fn group(object: &Object) -> &str {
        match object.name.as_str() {
            "candle" | "figure" => "light goes through",
            "foot" | "post" | "arm" | "hook" => "stand",
            other => other,
        }
    }
    let groups: BTreeSet<&str> = vitrine.objects.iter().map(group).collect();
    let subset = |kept: usize| {
        let is_kept = |object: &&Object| {
            groups.iter().position(|listed| *listed == group(object)).is_some_and(|place| kept >> place & 1 == 1)
        };
        Scene { objects: vitrine.objects.iter().filter(is_kept).cloned().collect(), ..vitrine.clone() }
    };
    let count = groups.len();
    assert!(count >= 7, "{groups:?}");
    let alone: Vec<Parts> = (0..count).map(|place| parts(&subset(1 << place))).collect();
    let shared = parts(&subset(0));
    for kept in lapidary_testing::sampled(0..1 << count, 4) {
        let (resources, pipelines, steps) = parts(&subset(kept));
        let mut expected = shared.clone();
        for (_, (resources, pipelines, steps)) in alone.iter().enumerate().filter(|(place, _)| kept >> place & 1 == 1) {
            expected.0.extend(resources.iter().cloned());
            expected.1.extend(pipelines.iter().cloned());
            expected.2.extend(steps.iter().cloned());
        }
        assert_eq!((resources, pipelines, steps), expected, "subset {kept:b}");
    }
    // Each object also has a resource of its own.
    for object in &vitrine.objects {
        let is_own = |name: &str| name.starts_with(&format!("{}/", object.name));
        assert!(alone.iter().any(|parts| parts.0.iter().any(|resource| is_own(&resource.name))), "{}", object.name);
    }
}

#[test]
fn the_vitrine_is_drawn_as_planned_and_explained() {
    let vitrine = named("vitrine");
    assert_eq!(drawn(&vitrine, &settings()), planned(&vitrine, &settings()));
    let usual = Settings { rung: lapidary_plan::Rung::ByMaterial, ..Settings::of_size(512, 512) };
    let plan = Plan::of(&vitrine, &usual).expect("a plan").to_string();
    // The multiples of time are left out: their record is measured again and again.
    let untimed = |line: &str| match line.split_once("; ") {
        Some((quality, _)) if quality.starts_with("  quality") => quality.to_owned() + "\n",
        _ => line.to_owned() + "\n",
    };
    insta::assert_snapshot!("vitrine_plan", plan.lines().map(untimed).collect::<String>());
}

/// Plans as many objects as a large file has, all with one name. Each is planned under a name of
/// its own, and the time for each does not grow with their number.
#[test]
fn thousands_of_objects_are_planned() {
    const COUNT: usize = 4_000;
    let scene = named("octahedron");
    let objects = vec![scene.objects[0].clone(); COUNT];
    let plan = Plan::of(&Scene { objects, ..scene }, &settings()).expect("a plan");
    let names: BTreeSet<&str> = plan.objects.iter().map(|planned| planned.object.as_str()).collect();
    assert_eq!(names.len(), COUNT);
    assert!(names.contains("octahedron") && names.contains(format!("octahedron#{COUNT}").as_str()));
    let text = plan.to_string();
    assert!(text.lines().count() > COUNT, "{}", text.lines().count());
}

#[test]
fn the_reference_takes_nothing_of_a_device() {
    let plan = Plan::of(&named("wax"), &of_rung("reference")).expect("a plan");
    assert_eq!(plan.listing, Listing::default());
    assert!(plan.objects.iter().all(|planned| planned.decisions.on() == Effects::NONE));
    assert!(plan.to_string().contains("on the CPU"), "{plan}");
}

/// If no light is followed through a body, no resources are made for that. Without any light the
/// maps are one texel each.
#[test]
fn ways_that_are_left_out_take_nothing_along() {
    let left_out = Settings { without: Effects::of(&[Effect::OpticalPath]), ..of_rung("godunov-64") };
    let bunny = one("bunny");
    for effect in [Effect::Surface, Effect::Color, Effect::ExtinctionPerVoxel] {
        assert_eq!(off(&bunny, &left_out, effect), "optical_path is left out", "{effect}");
    }
    let dark = Scene { lights: Vec::new(), ..bunny };
    let listing = planned(&dark, &of_rung("godunov-64"));
    let maps: Vec<&Resource> = listing.resources.iter().filter(|resource| resource.name.contains("maps")).collect();
    assert!(!maps.is_empty() && maps.iter().all(|map| map.bytes <= 16), "{maps:?}");
    assert!(passes(&listing).iter().all(|pass| !["voxelize", "seeds", "solve"].contains(pass)));
}

/// The proxy is drawn only on request. Quality chooses within a technique, and a named rung
/// overrides it.
#[test]
fn shape_and_quality_choose_the_rung() {
    let rung = |scene: &Scene, quality| {
        let plan = Plan::of(scene, &Settings { quality, ..settings() }).expect("a plan");
        plan.objects[0].decisions.rung.to_string()
    };
    let all = |scene: &Scene| Quality::ALL.map(|quality| rung(scene, quality));
    for (name, technique) in [
        ("brilliant", Technique::Convex),
        ("step_cut", Technique::Convex),
        ("bunny_stone", Technique::Concave),
        ("prism_chain", Technique::Concave),
        ("wax", Technique::Cdrf),
        ("bunny", Technique::Translucent),
    ] {
        let wanted = Quality::ALL.map(|quality| technique.rung(quality).to_string());
        assert_eq!(all(&one(name)), wanted, "{name}");
        // Of curvature one rung is the nearest to the walks, and the cheapest up to noise.
        assert_eq!(wanted[0] == wanted[2], technique == Technique::Cdrf, "{name}");
        assert!(!wanted.iter().any(|rung| rung.contains("proxy")));
    }
    // A mesh with a hole is drawn by its triangles, and the plan says so.
    let mut open = one("octahedron");
    open.objects[0].mesh.indices.truncate(21);
    let plan = Plan::of(&open, &settings()).expect("a plan");
    assert_eq!(plan.objects[0].decisions.rung.to_string(), Technique::Concave.rung(Quality::Good).to_string());
    assert!(plan.to_string().contains("not closed"), "{plan}");
    let picture = render::render(gpu(), &open, &settings()).expect("drawn");
    assert!(picture.linear.iter().flatten().all(|value| value.is_finite()));
    let opaque = with_material("ruby", |material| Material { transmission: 0.0, ..material.clone() });
    assert_eq!(all(&opaque), ["lambert"; 3]);
    let mut named = one("octahedron");
    named.objects[0].material.solver = Some("accurate".parse().expect("a solver"));
    named.objects[0].material.sigma0 = Some(Vec3::ONE);
    assert_eq!(all(&named), ["accurate"; 3]);
}

/// A plan states the cost and the error of the chosen rung, from the committed ladder.
#[test]
fn a_plan_says_what_quality_stands_for() {
    let text_of = |quality| Plan::of(&one("ruby"), &Settings { quality, ..settings() }).expect("a plan").to_string();
    let (fast, best) = (text_of(Quality::Fast), text_of(Quality::Best));
    assert!(fast.contains("quality fast: FLIP 0.") && !fast.contains("times the time"), "{fast}");
    assert!(best.contains("quality best: FLIP 0.") && best.contains("times the time of fast"), "{best}");
    let named = Plan::of(&one("ruby"), &of_rung("convex-2")).expect("a plan").to_string();
    assert!(!named.contains("quality"), "{named}");
}
