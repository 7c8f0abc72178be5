//! Which passes of a frame must run again when a resource has other contents.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// What a pass reads and what it changes, by the places of resources.
#[derive(Debug, Default)]
struct Uses {
    reads: BTreeSet<u64>,
    writes: BTreeSet<u64>,
}

/// Returns, for each of these resources of a frame's description, the places of the passes that must run again when it
/// was written: those that read it, those after them that use what they change, and those before them that fill what
/// they read and what is changed further on.
pub fn again(
    document: &Value,
    texts: &[String],
    resources: impl IntoIterator<Item = u64>,
) -> BTreeMap<u64, Vec<usize>> {
    let uses: Vec<Uses> = list(&document["passes"]).map(|pass| uses(document, texts, pass)).collect();
    resources.into_iter().map(|resource| (resource, of_resource(&uses, resource))).collect()
}

fn of_resource(uses: &[Uses], resource: u64) -> Vec<usize> {
    let mut again: BTreeSet<usize> = (0..uses.len()).filter(|place| uses[*place].reads.contains(&resource)).collect();
    let mut open: Vec<usize> = again.iter().copied().collect();
    while let Some(place) = open.pop() {
        let Uses { reads, writes } = &uses[place];
        for (other, used) in uses.iter().enumerate() {
            let follows = other > place && !(writes.is_disjoint(&used.reads) && writes.is_disjoint(&used.writes));
            // What it reads is, after a whole frame, what the last pass left there.
            let is_refilled = |filled: &u64| {
                reads.contains(filled) && uses[place..].iter().any(|later| later.writes.contains(filled))
            };
            let refills = other < place && used.writes.iter().any(is_refilled);
            if (follows || refills) && again.insert(other) {
                open.push(other);
            }
        }
    }
    again.into_iter().collect()
}

fn list(value: &Value) -> impl Iterator<Item = &Value> {
    value.as_array().into_iter().flatten()
}

fn uses(document: &Value, texts: &[String], pass: &Value) -> Uses {
    let mut uses = Uses::default();
    for call in list(&pass["draws"]).chain(list(&pass["dispatches"])) {
        uses.reads.extend(call["indirect"].as_u64());
        let text = call["pipeline"].as_u64().and_then(|place| texts.get(place as usize)).map_or("", String::as_str);
        let changed = written(text);
        for group in
            list(&call["groups"]).filter_map(Value::as_u64).map(|place| &document["bind_groups"][place as usize])
        {
            for entry in list(&group["entries"]) {
                let Some(resource) = entry["resource"].as_u64() else { continue };
                uses.reads.insert(resource);
                if changed.iter().any(|(number, binding)| group["group"] == *number && entry["binding"] == *binding) {
                    uses.writes.insert(resource);
                }
            }
        }
    }
    for target in list(&pass["targets"]) {
        uses.writes.extend(target["texture"].as_u64());
        uses.reads.extend(target["texture"].as_u64().filter(|_| target["clear"].is_null()));
    }
    uses.writes.extend(pass["depth"]["texture"].as_u64());
    uses.reads.extend(pass["depth"]["texture"].as_u64().filter(|_| pass["depth"]["load"] == true));
    match pass["kind"].as_str() {
        Some("clear") => uses.writes.extend(pass["buffer"].as_u64()),
        Some("copy") => {
            uses.reads.extend(pass["from"].as_u64());
            uses.writes.extend(pass["to"].as_u64());
        }
        _ => {}
    }
    uses
}

/// Returns the bindings that WGSL as naga writes it may change, as group and binding.
fn written(text: &str) -> Vec<(u32, u32)> {
    text.split("@group(").skip(1).filter_map(declared).collect()
}

fn declared(text: &str) -> Option<(u32, u32)> {
    let (group, rest) = text.split_once(')')?;
    let (binding, rest) = rest.split_once("@binding(")?.1.split_once(')')?;
    let declaration = rest.split(';').next()?;
    let changes = declaration.contains("<storage, read_write>") || declaration.contains("texture_storage");
    changes.then_some((group.parse().ok()?, binding.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    const WRITES_ITS_SECOND: &str = "@group(0) @binding(0) \nvar<uniform> a: f32;\n@group(0) @binding(1) \n\
        var<storage, read_write> b: array<f32>;\n";

    /// 0 and 1 are given, 2 is summed up by two passes after it was cleared, and drawn from 1 and 2.
    fn document() -> Value {
        let group = |from: u64, to: u64| json!({"group": 0, "entries": [{"binding": 0, "resource": from}, {"binding": 1, "resource": to}]});
        let pass = |group: u64| json!({"kind": "compute", "dispatches": [{"pipeline": 0, "groups": [group], "workgroups": [1, 1, 1]}]});
        json!({
            "bind_groups": [group(0, 2), group(1, 2), {"group": 0, "entries": [{"binding": 0, "resource": 3}, {"binding": 2, "resource": 2}]}],
            "passes": [
                {"kind": "clear", "buffer": 2, "bytes": 4},
                pass(0),
                pass(1),
                {"kind": "render", "targets": [{"texture": 4, "layer": 0, "clear": [0, 0, 0, 0]}], "depth": null,
                    "draws": [{"pipeline": 0, "groups": [2]}]},
            ],
        })
    }

    #[test]
    fn what_reads_it_runs_again_and_what_was_summed_up_with_it() {
        let found = again(&document(), &[WRITES_ITS_SECOND.to_owned()], [0, 1, 3]);
        // What only the picture reads needs no sums.
        assert_eq!(found[&3], [3]);
        // Either part of the sum needs all of it from the clearing on.
        assert_eq!((&found[&0][..], &found[&1][..]), (&[0, 1, 2, 3][..], &[0, 1, 2, 3][..]));
    }

    #[test]
    fn a_binding_is_written_if_it_is_declared_so() {
        assert_eq!(written(WRITES_ITS_SECOND), [(0, 1)]);
        let stored = "@group(1) @binding(3) \nvar picture: texture_storage_2d<rgba8unorm,write>;";
        assert_eq!(written(stored), [(1, 3)]);
    }
}
