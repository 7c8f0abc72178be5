//! The objects of a scene under compiled recipes, and the pass that draws them.

use crate::frame::record::Record;
use crate::frame::{BindGroupId, Bound, Builder, Depth, Draw, Pass, PipelineId, RenderPass, Target};
use glam::{Mat4, Vec3};

/// One object to draw.
pub(crate) struct Body {
    /// Name of the object.
    pub(crate) name: String,
    /// Bind groups from group 1 on; `None` for a group that the pipeline does not read.
    pub(crate) groups: Vec<Option<BindGroupId>>,
    pub(crate) vertices: u32,
    /// Number of copies.
    pub(crate) instances: u32,
}

/// A recipe compiled for the effects of some objects, and those objects.
pub(crate) struct Variant {
    pub(crate) pipeline: PipelineId,
    /// Number of colour targets that the pipeline writes.
    pub(crate) targets: usize,
    /// Whether it reads the picture of the bodies that are not clear stones.
    pub(crate) reads_screen: bool,
    /// Resources of group 0 that the pipeline reads, by binding, from 1 on.
    pub(crate) shared: Vec<(u32, Bound)>,
    pub(crate) bodies: Vec<Body>,
}

/// Attachments that a pass draws to.
pub(crate) struct SceneTarget {
    pub(crate) colors: Vec<Target>,
    pub(crate) depth: Depth,
    /// Size in texels; the area starts at the upper left corner.
    pub(crate) size: [u32; 2],
}

/// Draws the objects of some variants as seen from an eye, in a pass of this name: one draw call
/// for each object, with the pipeline of its variant. `bound` are resources of group 0 of this view.
pub(crate) fn draw(
    builder: &mut Builder<'_>,
    variants: &[Variant],
    (name, is_drawn): (&str, &dyn Fn(&Variant) -> bool),
    (clip_from_world, eye, bound): (Mat4, Vec3, &[(u32, Bound)]),
    target: &SceneTarget,
) {
    // All recipes declare the same view struct.
    let view = Record::new("GemView").with("clip_from_world", clip_from_world).with("eye", eye);
    let uniform = builder.uniform("view", view);
    let mut draws = Vec::new();
    for variant in variants.iter().filter(|variant| is_drawn(variant)) {
        let resources = [&[(0, Bound::from(uniform))][..], bound, &variant.shared].concat();
        let group = builder.bind(variant.pipeline, 0, &resources);
        for body in &variant.bodies {
            let groups = [&[group][..], &body.groups].concat();
            let draw = builder.of_object(&body.name, |builder| builder.draw(variant.pipeline, groups, body.vertices));
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
