//! Sliders: what they say, their steps, and how a step changes a scene or a frame's fields.

use super::fields::Fields;
use glam::{Mat3, Vec3};
use lapidary_render::Settings;
use lapidary_scene::{Light, Scene};

/// A number of a scene that can be moved.
#[derive(Debug)]
pub struct Slider {
    /// Name in the page's address.
    pub name: &'static str,
    /// What it is, in a few words.
    pub label: &'static str,
    /// Its unit; empty for a ratio.
    pub unit: &'static str,
    /// The least and the greatest value; with `relative`, as factors of the value at the start.
    pub range: [f32; 2],
    /// Whether the range is a factor of the value at the start.
    pub relative: bool,
    /// Whether steps are ratios.
    pub logarithmic: bool,
    /// Number of steps besides the value at the start.
    pub steps: usize,
    /// The option of `cook render` that takes the value; empty if none does.
    pub option: &'static str,
    /// The value in the scene as it is.
    pub start: fn(&Scene) -> f32,
    /// What it changes.
    pub moves: Moves,
}

/// How a value changes a frame.
#[derive(Debug)]
pub enum Moves {
    /// The scene or the settings; the frame is made anew, and the fields compared.
    Scene(fn(&mut Scene, &mut Settings, f32)),
    /// Fields of buffers, by the frame's own and the value at the start and now.
    Fields(fn(&mut Fields<'_>, f32, f32)),
}

impl Slider {
    /// Returns the values of its steps, ascending, the scene's own among them, and the place of that.
    #[must_use]
    pub fn values(&self, scene: &Scene) -> (Vec<f32>, usize) {
        let start = (self.start)(scene);
        let [least, greatest] = self.range.map(|end| if self.relative { end * start } else { end });
        let step = |place: usize| {
            let share = place as f32 / (self.steps - 1) as f32;
            let value = if self.logarithmic {
                least * (greatest / least).powf(share)
            } else {
                least + (greatest - least) * share
            };
            // As a reader would write it: four digits.
            format!("{value:.3e}").parse().unwrap_or(value)
        };
        let mut values: Vec<f32> = (0..self.steps).map(step).collect();
        // Steps next to the start would look the same.
        let near = 0.3 * (greatest - least) / self.steps as f32;
        values.retain(
            |value| if self.logarithmic { (value / start).ln().abs() > 0.02 } else { (value - start).abs() > near },
        );
        values.push(start);
        values.sort_by(f32::total_cmp);
        let place = values.iter().position(|value| *value == start).unwrap_or_default();
        (values, place)
    }
}

/// Factor on radiance before the tone curve.
pub const EXPOSURE: Slider = Slider {
    name: "exposure",
    label: "Exposure",
    unit: "×",
    range: [0.125, 8.0],
    relative: false,
    logarithmic: true,
    steps: 25,
    option: "--exposure",
    start: |_| 1.0,
    moves: Moves::Fields(|fields, _, now| fields.set("frame", "exposure", &[now])),
};

/// Refractive index; all colours' indices move with it.
pub const INDEX: Slider = Slider {
    name: "index",
    label: "Index of refraction",
    unit: "",
    range: [1.3, 2.8],
    relative: false,
    logarithmic: false,
    steps: 31,
    option: "",
    start: |scene| of_first(scene, |material| material.ior),
    moves: Moves::Fields(|fields, start, now| {
        let moved = |values: Vec<f32>| values.iter().map(|value| value + (now - start)).collect::<Vec<_>>();
        for field in ["index", "channel_indices"] {
            let values = moved(fields.get("material", field));
            fields.set("material", field, &values);
        }
    }),
};

/// How far the colours' indices lie from the middle one.
pub const DISPERSION_STRENGTH: Slider = Slider {
    name: "dispersion",
    label: "Dispersion, as a factor of the mineral’s",
    unit: "×",
    range: [0.1, 5.0],
    relative: false,
    logarithmic: true,
    steps: 24,
    option: "",
    start: |_| 1.0,
    moves: Moves::Fields(|fields, _, now| {
        let middle = fields.get("material", "index")[0];
        let spread = |value: &f32| middle + now * (value - middle);
        let values: Vec<f32> = fields.get("material", "channel_indices").iter().map(spread).collect();
        fields.set("material", "channel_indices", &values);
    }),
};

/// Absorption inside a clear stone, of the colour that is absorbed most; the others in proportion.
pub const ABSORPTION: Slider = Slider {
    name: "absorption",
    label: "Absorption of the colour absorbed most, per radius of the stone",
    unit: "",
    range: [0.05, 5.0],
    relative: true,
    logarithmic: true,
    steps: 24,
    option: "",
    start: |scene| {
        of_first(scene, |material| {
            let share = material.attenuation_color.min_element().max(f32::MIN_POSITIVE);
            -share.ln() / material.attenuation_distance
        })
    },
    moves: Moves::Fields(|fields, start, now| {
        let values: Vec<f32> = fields.get("material", "absorption").iter().map(|value| value * (now / start)).collect();
        fields.set("material", "absorption", &values);
    }),
};

/// Mean way of red light between two scatterings; the other colours' in proportion.
pub const FREE_PATH: Slider = Slider {
    name: "free_path",
    label: "Mean free path of red light",
    unit: "mm",
    range: [0.25, 4.0],
    relative: true,
    logarithmic: true,
    steps: 9,
    option: "",
    start: |scene| {
        let medium = scene.objects.iter().find_map(|object| object.material.medium.as_ref());
        medium.map_or(1.0, |medium| 1.0 / medium.transport_extinction().x)
    },
    moves: Moves::Scene(|scene, _, now| {
        let factor = now / (FREE_PATH.start)(scene);
        for object in &mut scene.objects {
            if let Some(medium) = &mut object.material.medium {
                medium.scattering /= factor;
                medium.absorption /= factor;
            }
            if let Some(sigma0) = &mut object.material.sigma0 {
                *sigma0 *= factor;
            }
        }
    }),
};

/// Roughness of all surfaces.
pub const ROUGHNESS: Slider = Slider {
    name: "roughness",
    label: "Roughness of the surface",
    unit: "",
    range: [0.1, 1.0],
    relative: false,
    logarithmic: false,
    steps: 10,
    option: "",
    start: |scene| of_first(scene, |material| material.roughness),
    moves: Moves::Scene(|scene, _, now| scene.objects.iter_mut().for_each(|object| object.material.roughness = now)),
};

/// All lights, turned about the vertical axis.
pub const LIGHT_TURN: Slider = Slider {
    name: "turn",
    label: "Lights turned about the vertical",
    unit: "°",
    range: [-180.0, 180.0],
    relative: false,
    logarithmic: false,
    steps: 19,
    option: "",
    start: |_| 0.0,
    moves: Moves::Scene(|scene, _, now| {
        let middle = scene.bounds().centre();
        let turn = Mat3::from_rotation_y(now.to_radians());
        let moved = |place: Vec3| middle + turn * (place - middle);
        for light in &mut scene.lights {
            match light {
                Light::Directional { toward, .. } => *toward = turn * *toward,
                Light::Point { position, .. } => *position = moved(*position),
                Light::Spot { position, direction, .. } => {
                    *position = moved(*position);
                    *direction = turn * *direction;
                }
            }
        }
    }),
};

/// Power of all lights.
pub const LIGHT_POWER: Slider = Slider {
    name: "power",
    label: "Power of the lights",
    unit: "×",
    range: [0.125, 8.0],
    relative: false,
    logarithmic: true,
    steps: 7,
    option: "",
    start: |_| 1.0,
    moves: Moves::Scene(|scene, _, now| {
        for light in &mut scene.lights {
            match light {
                Light::Directional { irradiance, .. } => *irradiance *= now,
                Light::Point { intensity, .. } | Light::Spot { intensity, .. } => *intensity *= now,
            }
        }
    }),
};

fn of_first(scene: &Scene, value: fn(&lapidary_scene::Material) -> f32) -> f32 {
    scene.objects.first().map_or(1.0, |object| value(&object.material))
}
