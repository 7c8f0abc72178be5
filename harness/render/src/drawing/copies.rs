//! Copies of objects that are drawn as objects of their own.

use crate::settings::Settings;
use lapidary_plan::{Decisions, Effect};
use lapidary_scene::{Copies, Object, Scene};
use std::borrow::Cow;

/// Returns the scene with copies as objects of their own wherever they differ in colour and are not
/// drawn by instances.
pub(crate) fn with_copies_apart<'a>(scene: &'a Scene, settings: &Settings) -> Cow<'a, Scene> {
    let request = settings.request();
    let differs = |object: &Object| {
        object.copies.as_ref().is_some_and(Copies::is_coloured)
            && !Decisions::of(object, scene, &request).has(Effect::Instances)
    };
    if !scene.objects.iter().any(differs) {
        return Cow::Borrowed(scene);
    }
    let bodies = |object: &Object| if differs(object) { object.apart() } else { vec![object.clone()] };
    Cow::Owned(Scene { objects: scene.objects.iter().flat_map(bodies).collect(), ..scene.clone() })
}
