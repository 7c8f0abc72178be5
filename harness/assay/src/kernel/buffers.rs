//! The buffers of a kernel as a tuple of Rust values.

use crate::formula::Words;
use crate::shape::Shape;
use crate::value::Value;

/// The contents of one binding: a `Vec` of values for a runtime-sized array, otherwise one value.
pub trait Buffer: Clone {
    /// Returns the shape of an element, or of the value.
    fn shape() -> Shape;
    /// Returns whether the binding is a runtime-sized array.
    fn is_runtime_sized() -> bool;
    /// Appends the words of all elements.
    fn write(&self, words: &mut Words);
    /// Reads all whole elements that `words` holds.
    ///
    /// # Panics
    /// Panics for a single value if `words` is too short.
    fn read(words: &[u32]) -> Self;
}

impl<T: Value + Clone> Buffer for T {
    fn shape() -> Shape {
        <T as Value>::shape()
    }

    fn is_runtime_sized() -> bool {
        false
    }

    fn write(&self, words: &mut Words) {
        Value::write(self, words);
    }

    fn read(mut words: &[u32]) -> Self {
        Value::read(&mut words)
    }
}

impl<T: Value + Clone> Buffer for Vec<T> {
    fn shape() -> Shape {
        T::shape()
    }

    fn is_runtime_sized() -> bool {
        true
    }

    fn write(&self, words: &mut Words) {
        self.iter().for_each(|element| element.write(words));
    }

    fn read(words: &[u32]) -> Self {
        words.chunks_exact(T::shape().words()).map(|mut element| T::read(&mut element)).collect()
    }
}

/// The type of one binding's buffer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Type {
    /// Shape of an element, or of the value.
    pub shape: Shape,
    /// Whether the buffer is a runtime-sized array.
    pub is_runtime_sized: bool,
}

/// Formats the type as in WGSL.
impl std::fmt::Display for Type {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.is_runtime_sized { write!(f, "array<{}>", self.shape) } else { write!(f, "{}", self.shape) }
    }
}

/// The buffers of a kernel: a tuple, in the order of groups and bindings.
pub trait Buffers: Clone {
    /// Returns the type of each buffer.
    fn types() -> Vec<Type>;
    /// Returns the words of each buffer.
    fn words(&self) -> Vec<Words>;
    /// Reads each buffer from its words.
    fn of_words(words: &[Words]) -> Self;
}

macro_rules! tuples {
    ($($name:ident $index:tt),*) => {
        impl<$($name: Buffer),*> Buffers for ($($name,)*) {
            fn types() -> Vec<Type> {
                vec![$(Type { shape: $name::shape(), is_runtime_sized: $name::is_runtime_sized() }),*]
            }

            fn words(&self) -> Vec<Words> {
                vec![$({
                    let mut words = Words::new();
                    Buffer::write(&self.$index, &mut words);
                    words
                }),*]
            }

            fn of_words(words: &[Words]) -> Self {
                ($(<$name as Buffer>::read(&words[$index]),)*)
            }
        }
    };
}

tuples!(A 0);
tuples!(A 0, B 1);
tuples!(A 0, B 1, C 2);
tuples!(A 0, B 1, C 2, D 3);
tuples!(A 0, B 1, C 2, D 3, E 4);
tuples!(A 0, B 1, C 2, D 3, E 4, F 5);
tuples!(A 0, B 1, C 2, D 3, E 4, F 5, G 6);
tuples!(A 0, B 1, C 2, D 3, E 4, F 5, G 6, H 7);
