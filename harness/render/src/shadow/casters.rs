//! The bodies that may keep light from others.

use crate::light::lighting::Lighting;
use crate::objects::part::names;
use lapidary_plan::casting::{self, Casting};
use lapidary_scene::{Bounds, Object};

/// A body that keeps light from others, with its unique name.
pub(crate) type Caster<'a> = (String, &'a Object);

/// Returns the bodies of this kind that may keep light from some of `lit`, each given with its box.
pub(crate) fn casters_on<'a>(lighting: &Lighting<'a>, lit: &[(&Object, Bounds)], kind: Casting) -> Vec<Caster<'a>> {
    let scene = lighting.scene;
    let casts = |body: &Object| {
        let caster = (body, casting::bounds(body));
        lit.iter().any(|receiver| casting::casts(caster, *receiver, &scene.lights))
    };
    let all = scene.objects.iter().zip(names(scene));
    let wanted = all.filter(|(body, _)| Casting::of(body) == kind && casts(body));
    wanted.map(|(body, name)| (name, body)).collect()
}
