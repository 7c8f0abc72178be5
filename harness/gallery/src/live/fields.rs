//! Fields of a frame's buffers by name, and what differs between two frames.

use lapidary_render::frame::{Contents, Frame, Pipeline, Resource, ResourceKind};
use lapidary_specialise::layout::StructLayout;
use serde::Serialize;

/// A field of an element of a buffer: buffers may share a name, and hold several structs.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Place {
    /// Name of the buffer.
    pub buffer: String,
    /// Its number among those that hold a struct and have this name.
    pub nth: usize,
    /// Number of the struct in the buffer.
    pub element: usize,
    /// Name of the field.
    pub field: String,
}

impl Serialize for Place {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (&self.buffer, self.nth, self.element, &self.field).serialize(serializer)
    }
}

/// A copy of a frame's contents whose fields can be set by the ends of their buffers' names.
#[derive(Debug)]
pub struct Fields<'a> {
    frame: &'a Frame,
    /// The fields that were set.
    pub changed: Vec<(Place, Vec<f32>)>,
}

impl<'a> Fields<'a> {
    /// Nothing is set yet.
    #[must_use]
    pub fn of(frame: &'a Frame) -> Self {
        Self { frame, changed: Vec::new() }
    }

    /// Returns the value of a field in the first buffer of this name; empty if there is none.
    #[must_use]
    pub fn get(&self, name: &str, field: &str) -> Vec<f32> {
        self.places(name, field).first().map_or_else(Vec::new, |place| value(self.frame, place))
    }

    /// Sets a field in all buffers of this name.
    pub fn set(&mut self, name: &str, field: &str, value: &[f32]) {
        for place in self.places(name, field) {
            self.changed.push((place, value.to_vec()));
        }
    }

    fn places(&self, name: &str, field: &str) -> Vec<Place> {
        let is_named = |resource: &Resource| {
            resource.name == name || resource.name.rsplit_once('/').is_some_and(|(_, last)| last == name)
        };
        let has = |layout: &StructLayout| layout.fields.iter().any(|member| member.name == field);
        let held = self.frame.resources.iter().enumerate().filter(|(_, resource)| is_named(resource));
        held.filter(|(_, resource)| layout(resource).is_some_and(has))
            .map(|(index, resource)| Place {
                buffer: resource.name.clone(),
                nth: number(self.frame, index),
                element: 0,
                field: field.to_owned(),
            })
            .collect()
    }
}

/// Returns the layout of the struct that a buffer holds.
pub fn layout(resource: &Resource) -> Option<&'static StructLayout> {
    match resource.kind {
        ResourceKind::Buffer { layout: Some((_, layout)), .. } => Some(layout),
        _ => None,
    }
}

/// Returns the initial bytes of a resource; none for zeros.
#[must_use]
pub fn contents(resource: &Resource) -> Option<&[u8]> {
    match &resource.kind {
        ResourceKind::Buffer { contents: Contents::Bytes(bytes), .. }
        | ResourceKind::Texture { contents: Contents::Bytes(bytes), .. } => Some(bytes),
        _ => None,
    }
}

/// Returns the number of a buffer among those that hold a struct and have its name.
fn number(frame: &Frame, index: usize) -> usize {
    let name = &frame.resources[index].name;
    frame.resources[..index].iter().filter(|other| other.name == *name && layout(other).is_some()).count()
}

/// Returns the place of the resource that a field stands in.
#[must_use]
pub fn resource(frame: &Frame, place: &Place) -> Option<usize> {
    let mut named = (0..frame.resources.len()).filter(|index| {
        let resource = &frame.resources[*index];
        resource.name == place.buffer && layout(resource).is_some()
    });
    named.nth(place.nth)
}

/// Returns the value of a field; empty if there is none.
#[must_use]
pub fn value(frame: &Frame, place: &Place) -> Vec<f32> {
    let Some(resource) = resource(frame, place).map(|index| &frame.resources[index]) else { return Vec::new() };
    let (Some(layout), Some(bytes)) = (layout(resource), contents(resource)) else { return Vec::new() };
    let field = layout.fields.iter().find(|field| field.name == place.field);
    let words = field.map_or(&[][..], |field| &field.offsets);
    words.iter().map(|offset| word(bytes, place.element * layout.size + offset)).collect()
}

fn word(bytes: &[u8], offset: usize) -> f32 {
    bytes.get(offset..offset + 4).and_then(|four| four.try_into().ok()).map_or(0.0, f32::from_le_bytes)
}

/// Returns the fields that differ in another frame of the same structure, with their values there; `None` if anything
/// else differs.
#[must_use]
pub fn changed(frame: &Frame, next: &Frame) -> Option<Vec<(Place, Vec<f32>)>> {
    if difference(frame, next).is_some() {
        return None;
    }
    let mut all = Vec::new();
    for (index, (one, other)) in frame.resources.iter().zip(&next.resources).enumerate() {
        let (Some(bytes), Some(others)) = (contents(one), contents(other)) else { continue };
        if bytes == others {
            continue;
        }
        let layout = layout(one)?;
        let mut explained = bytes.to_vec();
        for element in 0..bytes.len() / layout.size {
            for field in &layout.fields {
                let start = element * layout.size;
                let differs = |offset: &usize| bytes[start + offset..][..4] != others[start + offset..][..4];
                if !field.offsets.iter().any(differs) {
                    continue;
                }
                for offset in &field.offsets {
                    explained[start + offset..][..4].copy_from_slice(&others[start + offset..][..4]);
                }
                let (buffer, nth) = (one.name.clone(), number(frame, index));
                let place = Place { buffer, nth, element, field: field.name.clone() };
                let value = field.offsets.iter().map(|offset| word(others, start + offset)).collect();
                all.push((place, value));
            }
        }
        if explained != others {
            return None;
        }
    }
    Some(all)
}

/// Whether a shader that reads the buffer of a field names the field; others do not notice its value.
#[must_use]
pub fn is_read(frame: &Frame, texts: &[String], document: &serde_json::Value, place: &Place) -> bool {
    let Some(index) = resource(frame, place) else { return false };
    let last = place.field.rsplit('.').next().unwrap_or(&place.field);
    let groups = document["bind_groups"].as_array().into_iter().flatten();
    groups
        .filter(|group| group["entries"].as_array().into_iter().flatten().any(|entry| entry["resource"] == index))
        .filter_map(|group| texts.get(usize::try_from(group["pipeline"].as_u64()?).ok()?))
        .any(|text| names_field(text, last))
}

/// Whether WGSL text reads a member of this name.
fn names_field(text: &str, field: &str) -> bool {
    let member = format!(".{field}");
    text.match_indices(&member).any(|(start, found)| {
        let next = text[start + found.len()..].chars().next();
        !next.is_some_and(|letter| letter.is_alphanumeric() || letter == '_')
    })
}

/// Says what of another frame differs in more than what buffers of structs hold; `None` if nothing does.
#[must_use]
pub fn difference(frame: &Frame, next: &Frame) -> Option<String> {
    let counts = |frame: &Frame| (frame.resources.len(), frame.pipelines.len());
    if counts(frame) != counts(next) {
        return Some(format!("{:?} resources and pipelines become {:?}", counts(frame), counts(next)));
    }
    let compiled = |pipeline: &Pipeline| {
        (pipeline.shader.recipe().to_owned(), pipeline.shader.entries().to_vec(), pipeline.shader.overrides().to_vec())
    };
    for (one, other) in frame.pipelines.iter().zip(&next.pipelines) {
        if one.kind != other.kind || compiled(one) != compiled(other) {
            return Some(format!("pipeline `{}`", one.name));
        }
    }
    let is_struct = |one: &Resource, other: &Resource| one.bytes() == other.bytes() && layout(one).is_some();
    for (one, other) in frame.resources.iter().zip(&next.resources) {
        if one.name != other.name || (one.kind != other.kind && !is_struct(one, other)) {
            return Some(format!("resource `{}`", one.name));
        }
    }
    let is_same = frame.bind_groups == next.bind_groups && frame.passes == next.passes;
    (!is_same).then(|| "passes or bind groups".to_owned())
}
