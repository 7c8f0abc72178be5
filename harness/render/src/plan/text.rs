//! A plan as text.

use super::{Kind, Pipeline, Plan, PlannedObject, Resource, Step};
use lapidary_plan::{Decision, Decisions, Rung};
use std::collections::HashMap;
use std::fmt;

/// Columns of a line that lists names.
const WIDTH: usize = 118;

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        writeln!(f, "{}: {}, {width}x{height}", self.scene, count(self.objects.len(), "object"))?;
        for group in alike(&self.objects) {
            writeln!(f)?;
            self.object(f, &group)?;
        }
        self.passes(f)?;
        self.pipelines(f)?;
        self.resources(f)?;
        if !self.notes.is_empty() {
            writeln!(f, "\nnotes")?;
            for note in &self.notes {
                writeln!(f, "  {note}")?;
            }
        }
        if !self.lacking.is_empty() {
            writeln!(f, "\nasked for by the file, and not drawn")?;
            for lacking in &self.lacking {
                writeln!(f, "  {lacking}")?;
            }
        }
        Ok(())
    }
}

/// Formats a number with its noun: `1 object`, `2 objects`.
fn count(number: usize, what: &str) -> String {
    if number == 1 { format!("1 {what}") } else { format!("{number} {what}s") }
}

/// Groups objects of one material that are drawn alike.
fn alike(objects: &[PlannedObject]) -> Vec<Vec<&PlannedObject>> {
    let mut groups: Vec<Vec<&PlannedObject>> = Vec::new();
    // There are few groups, however many objects there are.
    for object in objects {
        let same = |group: &&mut Vec<&PlannedObject>| {
            let Decisions { rung, effects, .. } = &group[0].decisions;
            let drawn_alike = *rung == object.decisions.rung && *effects == object.decisions.effects;
            group[0].material == object.material && drawn_alike
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(object),
            None => groups.push(vec![object]),
        }
    }
    groups
}

impl Plan {
    fn object(&self, f: &mut fmt::Formatter<'_>, group: &[&PlannedObject]) -> fmt::Result {
        let first = group[0];
        let names: Vec<&str> = group.iter().map(|object| object.object.as_str()).collect();
        writeln!(f, "{} (material `{}`)", names.join(", "), first.material)?;
        let Decisions { rung, reason, chosen, effects } = &first.decisions;
        if group.iter().all(|object| object.decisions.reason == *reason) {
            writeln!(f, "  {reason}")?;
        } else {
            for object in group {
                writeln!(f, "  {}: {}", object.object, object.decisions.reason)?;
            }
        }
        if *rung == Rung::Reference {
            return writeln!(f, "  by the reference, on the CPU: no recipe, pass or resource");
        }
        if let Some(chosen) = chosen {
            writeln!(f, "  {chosen}")?;
        }
        writeln!(f, "  so drawn by rung {rung} of recipe {}", rung.recipe())?;
        let (on, off): (Vec<&Decision>, Vec<&Decision>) = effects.iter().partition(|decision| decision.on);
        for decision in on {
            writeln!(f, "  on   {:<22} {}", decision.effect.name(), decision.reason)?;
        }
        let mut told: Vec<&str> = Vec::new();
        for decision in &off {
            if told.contains(&decision.reason.as_str()) {
                continue;
            }
            told.push(&decision.reason);
            let same = off.iter().filter(|other| other.reason == decision.reason);
            let names: Vec<&str> = same.map(|other| other.effect.name()).collect();
            let reason = &decision.reason;
            if let [name] = names[..] {
                writeln!(f, "  off  {name:<22} {reason}")?;
            } else {
                writeln!(f, "  off  {}:\n       {:<22} {reason}", names.join(", "), "")?;
            }
        }
        Ok(())
    }

    fn passes(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let steps = &self.listing.steps;
        if steps.is_empty() {
            return writeln!(f, "\npasses\n  none: this rung is computed on the CPU");
        }
        let wide = |column: fn(&Step) -> &str| steps.iter().map(|step| column(step).len()).max().unwrap_or(0);
        let [pass, object] = [wide(|step| &step.pass), wide(|step| &step.object)];
        writeln!(f, "\npasses, in order")?;
        for (number, step) in (1..).zip(steps) {
            let times = if step.times > 1 { format!(" x {}", step.times) } else { String::new() };
            writeln!(f, "{number:>3}  {:<pass$}  {:<object$}  {}{times}", step.pass, step.object, step.pipeline)?;
            let prefix = format!("{}/", step.object);
            let names = step.resources.iter().map(|name| name.strip_prefix(&prefix).unwrap_or(name).to_owned());
            list(f, "       ", names)?;
        }
        Ok(())
    }

    fn pipelines(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pipelines = &self.listing.pipelines;
        if pipelines.is_empty() {
            return Ok(());
        }
        writeln!(f, "\npipelines")?;
        for Pipeline { name, recipe, overrides, instructions, .. } in pipelines {
            let from = if name == recipe { String::new() } else { format!(" of recipe {recipe}") };
            writeln!(f, "  {name}{from}: {}", count(*instructions, "instruction"))?;
            let effect = |name: &str| name.strip_prefix("EFFECT_").map(str::to_lowercase);
            let on = overrides.iter().filter(|(_, value)| *value != 0.0).filter_map(|(name, _)| effect(name));
            let off = overrides.iter().filter(|(_, value)| *value == 0.0).filter_map(|(name, _)| effect(name));
            let others = overrides.iter().filter(|(name, _)| effect(name).is_none());
            list(f, "    on   ", on)?;
            list(f, "    off  ", off)?;
            list(f, "    with ", others.map(|(name, value)| format!("{name} {value}")))?;
        }
        Ok(())
    }

    fn resources(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let resources = &self.listing.resources;
        if resources.is_empty() {
            return Ok(());
        }
        writeln!(f, "\nresources: {}", bytes(self.listing.bytes()))?;
        // A resource that only one object reads is listed under that object, even if it was made
        // for all objects that might read it.
        let mut users: HashMap<&str, Option<&str>> = HashMap::new();
        for step in &self.listing.steps {
            for name in &step.resources {
                let user = users.entry(name).or_insert(Some(&step.object));
                *user = user.filter(|user| *user == step.object);
            }
        }
        let owner = |resource: &'_ Resource| {
            let user = users.get(&*resource.name).copied().flatten().unwrap_or_default();
            if resource.object.is_empty() { user.to_owned() } else { resource.object.clone() }
        };
        let mut by_owner: HashMap<String, Vec<&Resource>> = HashMap::new();
        for resource in resources {
            by_owner.entry(owner(resource)).or_default().push(resource);
        }
        let objects = self.objects.iter().map(|planned| planned.object.clone());
        let owners = std::iter::once(String::new()).chain(objects);
        for name in owners {
            let Some(owned) = by_owner.get(&name) else { continue };
            let sum = owned.iter().map(|resource| resource.bytes).sum();
            writeln!(f, "  {}: {}", if name.is_empty() { "of all" } else { &name }, bytes(sum))?;
            let prefix = format!("{name}/");
            let shown = owned.iter().map(|resource| {
                let short = resource.name.strip_prefix(&prefix).unwrap_or(&resource.name);
                if resource.kind == Kind::Sampler {
                    short.to_owned()
                } else {
                    format!("{short} {}", bytes(resource.bytes))
                }
            });
            list(f, "    ", shown)?;
        }
        Ok(())
    }
}

/// Writes names separated by commas, in lines with the same indentation; writes nothing if there
/// are no names.
fn list(f: &mut fmt::Formatter<'_>, lead: &str, names: impl Iterator<Item = String>) -> fmt::Result {
    let mut line = String::new();
    let mut start = lead.to_owned();
    for name in names {
        if !line.is_empty() && start.len() + line.len() + 2 + name.len() > WIDTH {
            writeln!(f, "{start}{line},")?;
            start = " ".repeat(lead.len());
            line.clear();
        }
        if !line.is_empty() {
            line.push_str(", ");
        }
        line.push_str(&name);
    }
    if line.is_empty() { Ok(()) } else { writeln!(f, "{start}{line}") }
}

/// Formats a size in the largest unit that it reaches: B, KiB, MiB.
fn bytes(bytes: u64) -> String {
    let [kibi, mebi] = [1024.0, 1024.0 * 1024.0];
    let value = bytes as f64;
    if value >= mebi {
        format!("{:.1} MiB", value / mebi)
    } else if value >= kibi {
        format!("{:.1} KiB", value / kibi)
    } else {
        format!("{bytes} B")
    }
}
