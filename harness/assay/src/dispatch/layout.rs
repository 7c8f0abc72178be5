//! Position of each word of a value in a buffer: naga's own offsets, strides and sizes.

use lapidary_specialise::layout::word_offsets;

/// The byte size of one element of a storage array and the byte offset of each of its words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Bytes from one element to the next.
    pub stride: usize,
    /// Byte offset of each word, in word order.
    pub offsets: Vec<usize>,
}

impl Layout {
    /// Returns the layout of an array of the struct type `name` in the storage address space.
    ///
    /// # Panics
    /// Panics if the module has no such struct: the caller has just generated it.
    pub fn of_struct(module: &naga::Module, name: &str) -> Layout {
        let (handle, _) =
            module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).expect("a generated struct");
        Self::of_type(module, handle)
    }

    /// Returns the layout of a type with a known shape; for a runtime-sized array, that of its
    /// elements.
    ///
    /// # Panics
    /// Panics if the module is not valid.
    pub fn of_type(module: &naga::Module, ty: naga::Handle<naga::Type>) -> Layout {
        // Other types have no shape.
        let offsets = |ty| word_offsets(module, ty, 0).expect("a type with a shape is made of words");
        if let naga::TypeInner::Array { base, size: naga::ArraySize::Dynamic, stride } = module.types[ty].inner {
            return Layout { stride: stride as usize, offsets: offsets(base) };
        }
        let mut layouter = naga::proc::Layouter::default();
        layouter.update(module.to_ctx()).expect("a validated module has layouts");
        Layout { stride: layouter[ty].to_stride() as usize, offsets: offsets(ty) }
    }

    /// Spreads rows of words over the bytes of a buffer.
    pub fn scatter(&self, words: &[u32], bytes: &mut [u8]) {
        let width = self.offsets.len();
        for (row, element) in words.chunks_exact(width).zip(bytes.chunks_exact_mut(self.stride)) {
            for (word, offset) in row.iter().zip(&self.offsets) {
                element[*offset..offset + 4].copy_from_slice(&word.to_ne_bytes());
            }
        }
    }

    /// Collects rows of words from the bytes of a buffer.
    pub fn gather(&self, bytes: &[u8], rows: usize, words: &mut Vec<u32>) {
        words.clear();
        words.reserve(rows * self.offsets.len());
        for element in bytes.chunks_exact(self.stride).take(rows) {
            for offset in &self.offsets {
                let word: [u8; 4] = element[*offset..offset + 4].try_into().expect("four bytes");
                words.push(u32::from_ne_bytes(word));
            }
        }
    }
}
