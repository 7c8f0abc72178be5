//! Nodes at a time of the file's animations.

use ::gltf::json::Root;
use ::gltf::json::animation::{Interpolation, Property, Sampler};
use ::gltf::json::scene::UnitQuaternion;
use ::gltf::json::validation::Checked;
use glam::{Quat, Vec4};

use super::accessor::Elements;
use super::buffers::Buffers;
use super::error::{GltfError, designation, item};
use super::kind::{Kind, ROTATIONS, SCALARS, VECTORS};
use super::nodes::has_no_direction;

/// Whether an animation of the file moves a node. Weights of morph targets, which are not drawn, move none.
pub(super) fn moves_nodes(root: &Root) -> bool {
    let mut channels = root.animations.iter().flat_map(|animation| &animation.channels);
    channels.any(|channel| channel.target.path != Checked::Valid(Property::MorphTargetWeights))
}

/// Gives the nodes the translations, rotations and scales that all animations have at `time`, in seconds. Before its first key and
/// after its last one an animation keeps that key's value. Of several that move one property of a node the last one counts. A file
/// without animations is refused: the time would be believed to matter.
pub(super) fn pose(root: &mut Root, buffers: &Buffers<'_>, time: f32) -> Result<(), GltfError> {
    if root.animations.is_empty() {
        let problem = "it has no animation, so that a time (--time) changes nothing; leave it out";
        return Err(GltfError::part("the file".to_owned(), problem));
    }
    let mut moved = Vec::new();
    for (number, animation) in root.animations.iter().enumerate() {
        let part = || designation("animation", number, animation.name.as_deref());
        for channel in &animation.channels {
            let Checked::Valid(property) = channel.target.path else {
                return Err(GltfError::part(part(), "a channel's path is none of glTF's; export it again"));
            };
            // Targets of morphs are not drawn, which is reported.
            if property == Property::MorphTargetWeights {
                continue;
            }
            let node = channel.target.node.value();
            let moves = item(&root.nodes, "node", node, part)?;
            let sampler = item(&animation.samplers, "sampler", channel.sampler.value(), part)?;
            let value = value(root, buffers, sampler, property, time, &part())?;
            let name = designation("node", node, moves.name.as_deref());
            check(value, property, time).map_err(|problem| GltfError::part(format!("{}, {name}", part()), problem))?;
            moved.push((node, property, value));
        }
    }
    for (index, property, value) in moved {
        let node = &mut root.nodes[index];
        if node.matrix.is_some() {
            let name = designation("node", index, node.name.as_deref());
            return Err(GltfError::part(name, "it has a matrix and is animated, which exclude each other; remove one"));
        }
        match property {
            Property::Translation => node.translation = Some(value.truncate().to_array()),
            Property::Rotation => node.rotation = Some(UnitQuaternion(value.to_array())),
            Property::Scale => node.scale = Some(value.truncate().to_array()),
            Property::MorphTargetWeights => {}
        }
    }
    Ok(())
}

/// Refuses a value that is no place, turn or size.
fn check(value: Vec4, property: Property, time: f32) -> Result<(), String> {
    let rotates = property == Property::Rotation;
    if value.is_finite() && !(rotates && has_no_direction(value.to_array())) {
        return Ok(());
    }
    let (what, fault) = match property {
        Property::Rotation => ("rotation", "0, 0, 0, 0 or not finite"),
        Property::Scale => ("scale", "not finite"),
        Property::Translation | Property::MorphTargetWeights => ("translation", "not finite"),
    };
    Err(format!("at {time} s its {what} is undefined, since a key is {fault}; mend the keys"))
}

/// Returns a sampler's value: a vector in its first three components, or a quaternion.
fn value(
    root: &Root,
    buffers: &Buffers<'_>,
    sampler: &Sampler,
    property: Property,
    time: f32,
    part: &str,
) -> Result<Vec4, GltfError> {
    let Checked::Valid(interpolation) = sampler.interpolation else {
        return Err(GltfError::part(part.to_owned(), "an interpolation is none of glTF's; export it again"));
    };
    let elements = |index: usize, kind: Kind| Elements::of(root, buffers, index, kind, part);
    let times: Vec<f32> = elements(sampler.input.value(), SCALARS)?.numbers().map(|[time]| time).collect();
    let rotates = property == Property::Rotation;
    let output = elements(sampler.output.value(), if rotates { ROTATIONS } else { VECTORS })?;
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if output.count() != each * times.len() {
        let (found, keys) = (output.count(), times.len());
        return Err(GltfError::part(
            part.to_owned(),
            format!(
                "a sampler has {keys} keys and {found} values, but must have {} values; export it again",
                each * keys
            ),
        ));
    }
    let keys: Vec<Vec4> = if rotates {
        output.numbers().map(Vec4::from_array).collect()
    } else {
        output.numbers().map(|[x, y, z]| Vec4::new(x, y, z, 0.0)).collect()
    };
    Ok(interpolated(&times, &keys, interpolation, rotates, time))
}

/// Returns the value at `time` by glTF's appendix C. Of a cubic spline each key has the tangent before it, its value and the tangent
/// after it.
fn interpolated(times: &[f32], keys: &[Vec4], interpolation: Interpolation, rotates: bool, time: f32) -> Vec4 {
    let key = |number: usize| match interpolation {
        Interpolation::CubicSpline => keys[3 * number + 1],
        Interpolation::Linear | Interpolation::Step => keys[number],
    };
    let after = times.partition_point(|key| *key <= time);
    if after == 0 {
        return key(0);
    }
    let before = after - 1;
    if after == times.len() || interpolation == Interpolation::Step {
        return key(before);
    }
    let length = times[after] - times[before];
    let share = (time - times[before]) / length;
    match interpolation {
        Interpolation::Step => key(before),
        Interpolation::Linear if rotates => {
            let [from, to] = [before, after].map(|number| Quat::from_vec4(key(number)).normalize());
            from.slerp(to, share).into()
        }
        Interpolation::Linear => key(before).lerp(key(after), share),
        Interpolation::CubicSpline => {
            let (square, cube) = (share * share, share * share * share);
            let leaving = keys[3 * before + 2] * length;
            let arriving = keys[3 * after] * length;
            key(before) * (2.0 * cube - 3.0 * square + 1.0)
                + leaving * (cube - 2.0 * square + share)
                + key(after) * (3.0 * square - 2.0 * cube)
                + arriving * (cube - square)
        }
    }
}
