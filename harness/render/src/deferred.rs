//! Deferred drawing (the paper's section 4.3.4): the gem recipe fills a geometry buffer, and a
//! lighting pass produces the picture.

use super::lighting::Lighting;
use super::pass::{DEPTH_FORMAT, SAMPLE_FORMAT, ScenePass, SceneTarget};
use super::{Environment, RenderError, Settings, Tile};
use crate::frame::record::Record;
use crate::frame::{Bound, Builder, Depth, PipelineId, PipelineSource, Target, Texture};
use glam::{Mat4, UVec2, Vec3};

/// Format of the colour targets: the one that engines use for emission, and precise enough for a
/// normal (2^-11 per component).
pub(super) const GEOMETRY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// Recipe of the lighting pass.
pub(super) const COMPOSITE: &str = "gem_composite";

/// Number of colour targets: emission, normal, reflectance.
pub(super) const TARGETS: usize = 3;

/// The geometry buffer of one tile and the lighting pass.
pub(super) struct DeferredPass {
    pipeline: PipelineId,
    environment: Option<Texture>,
    emission: Texture,
    normal: Texture,
    reflectance: Texture,
    depth: Texture,
}

impl DeferredPass {
    /// Creates the passes for the settings' environment and samples; `source` is the composed
    /// recipe of the lighting pass.
    pub(super) fn new(
        builder: &mut Builder<'_>,
        lighting: &Lighting<'_>,
        settings: &Settings,
        source: &str,
    ) -> Result<Self, RenderError> {
        let map = f64::from(u8::from(matches!(settings.environment, Environment::Map(_))));
        let pipeline = builder.render_pipeline(&PipelineSource {
            recipe: COMPOSITE,
            source,
            entries: ["gem_composite_vertex", "gem_composite_fragment"],
            constants: &[("EFFECT_ENVIRONMENT_MAP", map)],
            formats: &[SAMPLE_FORMAT],
            depth: None,
        })?;
        let [width, height] =
            [settings.width, settings.height].map(|side| settings.samples * side.min(Tile::side(settings.samples)));
        let [emission, normal, reflectance, depth] = [
            ("emission", GEOMETRY_FORMAT),
            ("normal", GEOMETRY_FORMAT),
            ("reflectance", GEOMETRY_FORMAT),
            ("geometry's depth", DEPTH_FORMAT),
        ]
        .map(|(what, format)| builder.target(what, [width, height, 1], format, wgpu::TextureUsages::TEXTURE_BINDING));
        let reads = builder.binds(pipeline, 0, 1);
        let environment = reads.then(|| lighting.environment(builder)).transpose()?;
        Ok(Self { pipeline, environment, emission, normal, reflectance, depth })
    }

    /// Fills the geometry buffer, then lights it.
    pub(super) fn draw(
        &self,
        builder: &mut Builder<'_>,
        gem: &ScenePass,
        (clip_from_world, eye): (Mat4, Vec3),
        samples: Texture,
        size: [u32; 2],
    ) {
        let target = SceneTarget {
            colors: [self.emission, self.normal, self.reflectance].map(Target::from).into(),
            depth: Depth { keep: true, ..self.depth.into() },
            size,
        };
        gem.draw(builder, ("scene", &|_| true), (clip_from_world, eye, &[]), &target);
        // In f64: the inverse of a perspective matrix loses digits that the depth still holds.
        let world_from_clip = clip_from_world.as_dmat4().inverse().as_mat4();
        let view = Record::new("GemCompositeView").with("world_from_clip", world_from_clip).with("eye", eye);
        let uniform = builder.uniform("composite's view", view.with("size", UVec2::from(size).as_vec2()));
        let mut resources: Vec<(u32, Bound)> = vec![(0, uniform.into())];
        resources.extend((2..).zip([self.emission, self.normal, self.reflectance, self.depth].map(Bound::from)));
        resources.extend(self.environment.map(|environment| (1, environment.into())));
        let group = builder.bind(self.pipeline, 0, &resources);
        let draw = builder.draw(self.pipeline, vec![group], 3);
        let [width, height] = size;
        builder.draw_to(COMPOSITE, &[samples], Some([0, 0, width, height]), vec![draw]);
    }
}

#[cfg(test)]
mod tests {
    use super::COMPOSITE;
    use crate::drawing::Texts;
    use crate::pixel::Viewer;
    use crate::{GemOptions, Settings, render_from};
    use glam::Vec3;
    use lapidary_assay::extremum::larger;
    use lapidary_gpu::{AdapterChoice, Gpu};
    use lapidary_scene::Scene;

    /// The paper's section 4.3.1 with a real depth buffer: its 32-bit values are off by 2^-24 of
    /// the range from near to far; the interpolation of clip coordinates and the product with the
    /// inverse matrix add a few units in the last place of the distance.
    #[test]
    fn positions_come_back_from_the_depth_buffer() {
        let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("a device");
        let shown = "return vec4f(textureLoad(reflectance, texel, 0).rgb * surroundings_radiance(reflected) + inside.rgb, 1.0f);";
        let source = lapidary_wgsl::recipe_source(COMPOSITE);
        assert!(source.contains(shown));
        // Every binding stays in use, and the output is the position.
        let planted =
            source.replace(shown, &format!("if (inside.r < 0.0f) {{ {shown} }}\n    return vec4f(world, 1.0f);"));
        for name in ["brilliant", "prism", "bunny_stone"] {
            let scene = Scene::named(name).expect("built in");
            let rung = "proxy-1".parse().expect("a rung");
            let settings = Settings {
                rung,
                samples: 1,
                gem: GemOptions { deferred: true, ..GemOptions::default() },
                ..Settings::of_size(128, 128)
            };
            let gem = lapidary_wgsl::recipe_source(rung.recipe());
            let texts = Texts { rung: Some(&gem), composite: Some(&planted) };
            let picture = render_from(gpu, &scene, &settings, texts, &mut |_, _| {}).expect("rendered");
            let viewer = Viewer::new(&scene, 128, 128);
            let (mut worst, mut seen) = (0f32, 0);
            for (index, &[x, y, z, alpha]) in (0..).zip(&picture.linear) {
                let (row, column): (u32, u32) = (index / 128, index % 128);
                let point = viewer.see(&scene.objects[0].mesh, f64::from(column) + 0.5, f64::from(row) + 0.5);
                let (Some(point), true) = (point, alpha > 0.0) else { continue };
                let eye = scene.camera.eye;
                // Perpendicular to the ray, no accuracy is lost. Along the ray, the error depends
                // on the depth and grows with the slant of the facet: if it is seen edge-on, the
                // two points differ by which point of the pixel is meant.
                let (direction, from_eye) = ((point.position - eye).normalize(), Vec3::new(x, y, z) - eye);
                worst = larger(worst, from_eye.cross(direction).length() / point.position.distance(eye));
                let along = (from_eye.dot(direction) - point.position.distance(eye)).abs();
                worst = larger(worst, along / point.position.distance(eye));
                seen += 1;
            }
            println!("{name}: {seen} pixels, off by {worst:e} of the distance at most");
            assert!(seen > 1000 && worst <= 16.0 * f32::EPSILON, "{name}: {seen} pixels, {worst:e}");
        }
    }
}
