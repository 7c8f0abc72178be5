//! Draws a glTF file's stones in Bevy, without a window, and writes the picture.

mod dispersion;
mod gem;

use bevy::app::{AppExit, ScheduleRunnerPlugin};
use bevy::asset::{LoadState, RenderAssetUsages, UnapprovedPathMode};
use bevy::camera::{Hdr, RenderTarget};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::log::{Level, LogPlugin};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat, TextureUsages};
use bevy::window::ExitCondition;
use std::time::Duration;

/// Pixels along each side of the picture, and samples along each side of a pixel.
const SIZE: u32 = 512;
const SAMPLES: u32 = 4;
/// Time in which a stone must appear.
const PATIENCE: Duration = Duration::from_secs(30);

/// The file, and where the picture goes.
#[derive(Resource)]
struct Job {
    glb: String,
    picture: String,
}

/// The camera's target.
#[derive(Resource)]
struct Samples(Handle<Image>);

fn main() -> AppExit {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [glb, picture] = &arguments[..] else {
        eprintln!("Usage: lapidary-in-bevy STONE.glb PICTURE.png");
        return AppExit::from_code(2);
    };
    let headless = DefaultPlugins
        .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
        .set(AssetPlugin { unapproved_path_mode: UnapprovedPathMode::Allow, ..default() })
        .set(LogPlugin { level: Level::ERROR, ..default() })
        // The first frame that shows the stone shows it whole.
        .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() });
    App::new()
        .add_plugins((headless, ScheduleRunnerPlugin::run_loop(Duration::ZERO), gem::GemPlugin))
        .insert_resource(Job { glb: glb.clone(), picture: picture.clone() })
        .insert_resource(ClearColor(Color::NONE))
        .add_systems(Startup, load)
        .add_systems(Update, (aim, refuse))
        .run()
}

fn load(job: Res<Job>, assets: Res<AssetServer>, mut images: ResMut<Assets<Image>>, mut commands: Commands) {
    let side = SIZE * SAMPLES;
    let mut samples = Image::new_target_texture(side, side, TextureFormat::Rgba32Float, None);
    samples.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    samples.asset_usage = RenderAssetUsages::RENDER_WORLD;
    let samples = images.add(samples);
    commands.insert_resource(Samples(samples.clone()));
    commands.spawn(Readback::texture(samples)).observe(show);
    commands.spawn(WorldAssetRoot(assets.load(GltfAssetLabel::Scene(0).from_asset(job.glb.clone()))));
}

/// Turns the file's camera to the target: linear radiance, as the material computes it.
fn aim(mut cameras: Query<(Entity, &mut Projection), Added<Camera3d>>, samples: Res<Samples>, mut commands: Commands) {
    for (camera, mut projection) in &mut cameras {
        // Bevy looks at a camera's new target only when its projection changes.
        projection.set_changed();
        commands.entity(camera).insert((
            RenderTarget::Image(samples.0.clone().into()),
            Hdr,
            Tonemapping::None,
            // A sample a ray: the average comes after the tone curve, in `show`.
            Msaa::Off,
        ));
    }
}

/// Ends the program if the file cannot be loaded.
fn refuse(roots: Query<&WorldAssetRoot>, job: Res<Job>, assets: Res<AssetServer>, mut exit: MessageWriter<AppExit>) {
    for root in &roots {
        // Bevy's log has said why.
        if let Some(LoadState::Failed(_)) = assets.get_load_state(&root.0) {
            eprintln!("lapidary-in-bevy: {} cannot be loaded", job.glb);
            exit.write(AppExit::error());
        }
    }
}

/// Shows the samples as the cookbook's own pictures do: over its backdrop, by its tone curve.
fn show(samples: On<ReadbackComplete>, job: Res<Job>, time: Res<Time<Real>>, mut exit: MessageWriter<AppExit>) {
    let samples: Vec<Vec4> = samples.to_shader_type();
    if samples.iter().all(|sample| sample.w == 0.0) {
        if time.elapsed() > PATIENCE {
            eprintln!("lapidary-in-bevy: {} shows no stone to its camera", job.glb);
            exit.write(AppExit::error());
        }
        return;
    }
    let pixels = (0..SIZE * SIZE).flat_map(|pixel| pixel_of(&samples, pixel % SIZE, pixel / SIZE)).collect();
    let size = Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 };
    let format = TextureFormat::Rgba8UnormSrgb;
    let image = Image::new(size, TextureDimension::D2, pixels, format, RenderAssetUsages::MAIN_WORLD);
    let saved = image.try_into_dynamic().map_err(|error| error.to_string());
    match saved.and_then(|image| image.save(&job.picture).map_err(|error| error.to_string())) {
        Ok(()) => exit.write(AppExit::Success),
        Err(error) => {
            eprintln!("lapidary-in-bevy: {}: {error}", job.picture);
            exit.write(AppExit::error())
        }
    };
}

fn pixel_of(samples: &[Vec4], x: u32, y: u32) -> [u8; 4] {
    // Dark paper with a soft light behind the stone.
    let from_light = (Vec2::new(x as f32, y as f32) + 0.5) / SIZE as f32 - Vec2::new(0.5, 0.55);
    let falloff = (-3.0 * from_light.length_squared()).exp();
    let behind = Vec3::new(0.006, 0.007, 0.010).lerp(Vec3::new(0.055, 0.062, 0.078), falloff);
    let mut light = Vec3::ZERO;
    for row in SAMPLES * y..SAMPLES * (y + 1) {
        for column in SAMPLES * x..SAMPLES * (x + 1) {
            let sample = samples[(row * SIZE * SAMPLES + column) as usize];
            // The tone curve first: a pixel emits the mean of what its samples would emit.
            light += lapidary_srgb::tone_curve(sample.truncate() + (1.0 - sample.w) * behind);
        }
    }
    let encoded = lapidary_srgb::encode_color(light / (SAMPLES * SAMPLES) as f32);
    let [red, green, blue] = encoded.to_array().map(|channel| (255.0 * channel).round() as u8);
    [red, green, blue, u8::MAX]
}
