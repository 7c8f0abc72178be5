//! A scene in a frame: its objects under compiled recipes, and the passes that draw them.

use super::blur::Blur;
use super::diffusion::Diffusions;
use super::optical_path::OpticalPaths;
use super::shadows::Shadows;
use super::stage::Stage;
use crate::frame::record::Record;
use crate::frame::{BindGroupId, Bound, Builder, Depth, Draw, Pass, PipelineId, RenderPass, Target};
use glam::{Mat4, Vec3};
use std::ops::Range;

/// Format of the samples. f32, because radiance spans more than f16 holds exactly, and references
/// are compared in linear light.
pub(super) const SAMPLE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Format of the depth buffer.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// One object to draw.
pub(super) struct Body {
    /// Name of the object.
    pub(super) name: String,
    /// Bind groups from group 1 on; `None` for a group that the pipeline does not read.
    pub(super) groups: Vec<Option<BindGroupId>>,
    pub(super) vertices: u32,
    /// Number of copies.
    pub(super) instances: u32,
}

/// A recipe compiled for the effects of some objects, and those objects.
pub(super) struct Variant {
    pub(super) pipeline: PipelineId,
    /// Number of colour targets that the pipeline writes.
    pub(super) targets: usize,
    /// Whether it reads the picture of the bodies that are not clear stones.
    pub(super) reads_screen: bool,
    /// Resources of group 0 that the pipeline reads, by binding, from 1 on.
    pub(super) shared: Vec<(u32, Bound)>,
    pub(super) bodies: Vec<Body>,
}

/// Compiled recipes and the scene's objects.
#[derive(Default)]
pub(super) struct ScenePass {
    pub(super) variants: Vec<Variant>,
    pub(super) before: Vec<Before>,
}

/// Work done once per frame before the objects are drawn, whose results they look up.
pub(super) enum Before {
    /// The lights' views of the scene, for shadows.
    Shadows(Shadows),
    /// Irradiance, drawn into an object's texture and blurred.
    Blur(Blur),
    /// Paths of light through the objects.
    Paths(OpticalPaths),
    /// Diffusion of light through the objects.
    Diffusions(Diffusions),
}

/// Attachments that a pass draws to.
pub(super) struct SceneTarget {
    pub(super) colors: Vec<Target>,
    pub(super) depth: Depth,
    /// Size in texels; the area starts at the upper left corner.
    pub(super) size: [u32; 2],
}

impl ScenePass {
    /// Appends the objects and the preparing passes of `other`.
    pub(super) fn append(&mut self, other: Self) {
        self.variants.extend(other.variants);
        self.before.extend(other.before);
    }

    /// Encodes the preparing passes. Returns the range of passes of each stage of the paths of
    /// light, or `None` if the rung follows none.
    pub(super) fn prepare(&self, builder: &mut Builder<'_>) -> Option<[Range<usize>; Stage::ALL.len() - 1]> {
        let mut stages = None;
        for before in &self.before {
            match before {
                Before::Shadows(shadows) => shadows.encode(builder),
                Before::Blur(blur) => blur.encode(builder),
                Before::Paths(paths) => stages = Some(paths.encode(builder)),
                Before::Diffusions(diffusions) => stages = Some(diffusions.encode(builder)),
            }
        }
        stages
    }

    /// Paths of light, of each rung that follows any.
    pub(super) fn paths(&self) -> impl Iterator<Item = &OpticalPaths> {
        self.before.iter().filter_map(|before| match before {
            Before::Paths(paths) => Some(paths),
            Before::Shadows(_) | Before::Blur(_) | Before::Diffusions(_) => None,
        })
    }

    /// Diffusion of light, of each rung by it.
    pub(super) fn diffusions(&self) -> impl Iterator<Item = &Diffusions> {
        self.before
            .iter()
            .filter_map(|before| if let Before::Diffusions(diffusions) = before { Some(diffusions) } else { None })
    }

    /// Draws the objects of some variants as seen from an eye, in a pass of this name: one draw call
    /// for each object, with the pipeline of its variant. `bound` are resources of group 0 of this view.
    pub(super) fn draw(
        &self,
        builder: &mut Builder<'_>,
        (name, is_drawn): (&str, &dyn Fn(&Variant) -> bool),
        (clip_from_world, eye, bound): (Mat4, Vec3, &[(u32, Bound)]),
        target: &SceneTarget,
    ) {
        // All recipes declare the same view struct.
        let view = Record::new("GemView").with("clip_from_world", clip_from_world).with("eye", eye);
        let uniform = builder.uniform("view", view);
        let mut draws = Vec::new();
        for variant in self.variants.iter().filter(|variant| is_drawn(variant)) {
            let resources = [&[(0, Bound::from(uniform))][..], bound, &variant.shared].concat();
            let group = builder.bind(variant.pipeline, 0, &resources);
            for body in &variant.bodies {
                let groups = [&[group][..], &body.groups].concat();
                let draw =
                    builder.of_object(&body.name, |builder| builder.draw(variant.pipeline, groups, body.vertices));
                draws.push(Draw { instances: body.instances, ..draw });
            }
        }
        let [width, height] = target.size;
        builder.pass(Pass::Render(RenderPass {
            name: name.to_owned(),
            targets: target.colors.clone(),
            depth: Some(target.depth),
            viewport: Some([0, 0, width, height]),
            draws,
        }));
    }
}
