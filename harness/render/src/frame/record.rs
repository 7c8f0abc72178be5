//! Structs of the recipes as bytes, filled by field name.

use glam::{Mat3, Mat4, UVec2, UVec4, Vec2, Vec3, Vec4};
use lapidary_specialise::layout::StructLayout;
use naga::ScalarKind;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A struct being filled. Wrong names and kinds are faults of the renderer itself, which its first
/// picture reveals: they panic.
pub(crate) struct Record {
    name: &'static str,
    layout: &'static StructLayout,
    /// Prefix of the names of the fields being filled: fields of an inner struct are named
    /// `outer.inner`.
    outer: String,
    bytes: Vec<u8>,
    filled: Vec<bool>,
}

impl Record {
    /// Starts a struct of this name, which at least one recipe must declare.
    pub(crate) fn new(name: &'static str) -> Self {
        let layout = layout(name);
        let (bytes, filled) = (vec![0; layout.size], vec![false; layout.fields.len()]);
        Self { name, layout, outer: String::new(), bytes, filled }
    }

    /// Fills a field.
    #[must_use]
    pub(crate) fn with(mut self, field: &str, value: impl Words) -> Self {
        let Self { name, layout, outer, bytes, filled } = &mut self;
        let place = layout.fields.iter().position(|known| known.name.strip_prefix(outer.as_str()) == Some(field));
        let place = place.unwrap_or_else(|| panic!("`{name}` has no field `{outer}{field}`"));
        let (known, (kind, words)) = (&layout.fields[place], value.words());
        assert_eq!((kind, words.len()), (known.kind, known.offsets.len()), "`{name}.{outer}{field}`");
        for (offset, word) in known.offsets.iter().zip(words) {
            bytes[*offset..offset + 4].copy_from_slice(&word.to_ne_bytes());
        }
        filled[place] = true;
        self
    }

    /// Fills a field that is itself a struct.
    #[must_use]
    pub(crate) fn within(mut self, field: &str, fill: impl FnOnce(Self) -> Self) -> Self {
        let inner = format!("{}{field}.", self.outer);
        let outer = std::mem::replace(&mut self.outer, inner);
        Self { outer, ..fill(self) }
    }

    /// Returns the struct's name and layout.
    pub(crate) fn layout(&self) -> (&'static str, &'static StructLayout) {
        (self.name, self.layout)
    }

    /// Returns the bytes, padded to a multiple of 16 as in uniforms.
    pub(crate) fn bytes(mut self) -> Vec<u8> {
        let empty = self.filled.iter().position(|filled| !filled);
        assert_eq!(empty.map(|place| &self.layout.fields[place].name), None, "`{}` is not filled", self.name);
        self.bytes.resize(self.bytes.len().next_multiple_of(16), 0);
        self.bytes
    }
}

/// Returns the layout of a struct, from the first recipe that declares it. Each recipe is parsed at
/// most once.
fn layout(name: &str) -> &'static StructLayout {
    static LAYOUTS: Mutex<BTreeMap<String, &'static StructLayout>> = Mutex::new(BTreeMap::new());
    let mut layouts = LAYOUTS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = layouts.get(name) {
        return known;
    }
    let declares = |text: &String| text.contains(&format!("struct {name} {{"));
    let text = lapidary_wgsl::RECIPES.iter().map(lapidary_wgsl::Recipe::compose).find(declares);
    let module = text.map(|text| naga::front::wgsl::parse_str(&text).expect("the cookbook's WGSL"));
    for (name, layout) in module.iter().flat_map(StructLayout::all) {
        // Leaks once for each struct that exists.
        layouts.entry(name.to_owned()).or_insert_with(|| Box::leak(Box::new(layout)));
    }
    layouts.get(name).unwrap_or_else(|| panic!("no recipe holds a struct `{name}`"))
}

/// A value that a field can hold.
pub(crate) trait Words {
    /// Returns the value's scalars, all of one kind.
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

impl Words for UVec4 {
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

impl Words for [Vec4; 3] {
    fn words(self) -> (ScalarKind, Vec<u32>) {
        self.as_slice().words()
    }
}

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
    fn an_inner_struct_is_filled_by_its_own_names() {
        let seeding = |fill: fn(Record) -> Record| {
            let record = Record::new("OpticalPathSeeding").within("grid", fill);
            record.with("extinction", 2.0).with("largest", 3.0).with("channel", 1u32).bytes()
        };
        let grid = |record: Record| record.with("origin", Vec3::X).with("spacing", 0.5).with("cells", 64u32);
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&seeding(grid));
        let [one, half, two, three] = [1f32, 0.5, 2.0, 3.0].map(f32::to_bits);
        assert_eq!(words, [one, 0, 0, half, 64, 0, 0, 0, two, three, 1, 0]);
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

    /// All recipes that draw bodies share one view buffer.
    #[test]
    fn all_views_are_alike() {
        let gem = layout("GemView");
        assert_eq!([layout("CdrfView"), layout("OpticalPathView")], [gem, gem]);
    }
}
