//! Structs of the recipes as bytes, filled by the names of their fields.

use glam::{Mat3, Mat4, UVec2, Vec2, Vec3, Vec4};
use lapidary_specialise::layout::StructLayout;
use naga::ScalarKind;
use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock, PoisonError};

/// A struct that is being filled. Wrong names and kinds are the renderer's own faults, which its first picture shows: they panic.
pub(crate) struct Record {
    name: &'static str,
    layout: &'static StructLayout,
    bytes: Vec<u8>,
    filled: Vec<bool>,
}

impl Record {
    /// The struct of this name, which one recipe at least holds.
    pub(crate) fn new(name: &'static str) -> Self {
        let layout = layout(name);
        Self { name, layout, bytes: vec![0; layout.size], filled: vec![false; layout.fields.len()] }
    }

    /// Fills a field; one of an inner struct is named `outer.inner`.
    #[must_use]
    pub(crate) fn with(mut self, field: &str, value: impl Words) -> Self {
        let Self { name, layout, bytes, filled } = &mut self;
        let place = layout.fields.iter().position(|known| known.name == field);
        let place = place.unwrap_or_else(|| panic!("`{name}` has no field `{field}`"));
        let (known, (kind, words)) = (&layout.fields[place], value.words());
        assert_eq!((kind, words.len()), (known.kind, known.offsets.len()), "`{name}.{field}`");
        for (offset, word) in known.offsets.iter().zip(words) {
            bytes[*offset..offset + 4].copy_from_slice(&word.to_ne_bytes());
        }
        filled[place] = true;
        self
    }

    /// Its bytes, up to a multiple of 16, as uniforms have them.
    pub(crate) fn bytes(mut self) -> Vec<u8> {
        let empty = self.filled.iter().position(|filled| !filled);
        assert_eq!(empty.map(|place| &self.layout.fields[place].name), None, "`{}` is not filled", self.name);
        self.bytes.resize(self.bytes.len().next_multiple_of(16), 0);
        self.bytes
    }
}

/// The layout of a struct, from the first recipe that holds it.
fn layout(name: &'static str) -> &'static StructLayout {
    static LAYOUTS: OnceLock<Mutex<BTreeMap<&'static str, &'static StructLayout>>> = OnceLock::new();
    let mut layouts = LAYOUTS.get_or_init(Mutex::default).lock().unwrap_or_else(PoisonError::into_inner);
    layouts.entry(name).or_insert_with(|| {
        let declares = |text: &String| text.contains(&format!("struct {name} {{"));
        let text = lapidary_wgsl::RECIPES.iter().map(lapidary_wgsl::Recipe::compose).find(declares);
        let module = text.map(|text| lapidary_specialise::parse(&text, name));
        let found = module.and_then(|module| StructLayout::named(&module.ok()?.0, name));
        // Once for each struct there is.
        Box::leak(Box::new(found.unwrap_or_else(|| panic!("no recipe holds a struct `{name}`"))))
    })
}

/// What a field may hold.
pub(crate) trait Words {
    /// Its scalars, of one kind.
    fn words(self) -> (ScalarKind, Vec<u32>);
}

fn floats(values: &[f32]) -> (ScalarKind, Vec<u32>) {
    (ScalarKind::Float, values.iter().map(|value| value.to_bits()).collect())
}

impl Words for f32 {
    fn words(self) -> (ScalarKind, Vec<u32>) {
        floats(&[self])
    }
}

impl Words for u32 {
    fn words(self) -> (ScalarKind, Vec<u32>) {
        (ScalarKind::Uint, vec![self])
    }
}

impl Words for UVec2 {
    fn words(self) -> (ScalarKind, Vec<u32>) {
        (ScalarKind::Uint, self.to_array().to_vec())
    }
}

macro_rules! of_floats {
    ($($type:ty: $array:ident),*) => {$(
        impl Words for $type {
            fn words(self) -> (ScalarKind, Vec<u32>) {
                floats(&self.$array())
            }
        }
    )*};
}

of_floats!(Vec2: to_array, Vec3: to_array, Vec4: to_array, Mat3: to_cols_array, Mat4: to_cols_array);

impl Words for &[Vec4] {
    fn words(self) -> (ScalarKind, Vec<u32>) {
        floats(&self.iter().flat_map(|row| row.to_array()).collect::<Vec<f32>>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_filled_by_name() {
        let record = Record::new("OpticalPathGrid").with("spacing", 0.5).with("cells", 64u32).with("extinction", 3.0);
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&record.bytes());
        assert_eq!(words, [64, 3f32.to_bits(), 0.5f32.to_bits(), 0]);
    }

    #[test]
    #[should_panic(expected = "`OpticalPathGrid` has no field `size`")]
    fn a_wrong_name_is_refused() {
        let _ = Record::new("OpticalPathGrid").with("size", 1u32);
    }

    #[test]
    #[should_panic(expected = "`OpticalPathGrid.cells`")]
    fn a_wrong_kind_is_refused() {
        let _ = Record::new("OpticalPathGrid").with("cells", 1.0);
    }

    #[test]
    #[should_panic(expected = "`OpticalPathGrid` is not filled")]
    fn what_is_left_out_is_refused() {
        let _ = Record::new("OpticalPathGrid").with("cells", 1u32).bytes();
    }

    /// One buffer serves all recipes that draw bodies.
    #[test]
    fn all_views_are_alike() {
        let gem = layout("GemView");
        assert_eq!([layout("CdrfView"), layout("OpticalPathView")], [gem, gem]);
    }
}
