//! Conversion between Rust values and words, for mirrors (32-bit) and for oracles (f64).

use crate::shape::{Scalar, Shape};
use glam::{
    BVec2, BVec3, BVec4, DMat2, DMat3, DMat4, DVec2, DVec3, DVec4, IVec2, IVec3, IVec4, Mat2, Mat3, Mat4, UVec2, UVec3,
    UVec4, Vec2, Vec3, Vec4,
};

/// A value of a mirror, with the shape of a WGSL type.
pub trait Value: Sized {
    /// Returns the WGSL type.
    fn shape() -> Shape;
    /// Appends the value's words.
    fn write(&self, words: &mut Vec<u32>);
    /// Reads a value and removes its words from the front.
    ///
    /// # Panics
    /// Panics if `words` is shorter than the shape.
    fn read(words: &mut &[u32]) -> Self;
}

/// A value of an oracle: the same shape with every float widened to f64. Bools become 0 and 1;
/// integers keep their value.
pub trait Exact: Sized {
    /// Returns the shape of the corresponding mirror value.
    fn shape() -> Shape;
    /// Appends the value's numbers.
    fn write(&self, numbers: &mut Vec<f64>);
    /// Reads a value and removes its numbers from the front.
    ///
    /// # Panics
    /// Panics if `numbers` is shorter than the shape.
    fn read(numbers: &mut &[f64]) -> Self;
}

fn take<T: Copy>(words: &mut &[T]) -> T {
    let (first, rest) = words.split_first().expect("as many words as the shape has");
    *words = rest;
    *first
}

macro_rules! scalars {
    ($($type:ty, $scalar:ident, $to:expr, $from:expr;)*) => {$(
        impl Value for $type {
            fn shape() -> Shape { Shape::Scalar(Scalar::$scalar) }
            fn write(&self, words: &mut Vec<u32>) { words.push(($to)(*self)) }
            fn read(words: &mut &[u32]) -> Self { ($from)(take(words)) }
        }
    )*};
}

scalars! {
    f32, F32, f32::to_bits, f32::from_bits;
    u32, U32, |value: u32| value, |word: u32| word;
    i32, I32, |value: i32| value.cast_unsigned(), |word: u32| word.cast_signed();
    bool, Bool, u32::from, |word: u32| word != 0;
}

macro_rules! exact_scalars {
    ($($type:ty, $scalar:ident, $to:expr, $from:expr;)*) => {$(
        impl Exact for $type {
            fn shape() -> Shape { Shape::Scalar(Scalar::$scalar) }
            fn write(&self, numbers: &mut Vec<f64>) { numbers.push(($to)(*self)) }
            fn read(numbers: &mut &[f64]) -> Self { ($from)(take(numbers)) }
        }
    )*};
}

exact_scalars! {
    f64, F32, |value: f64| value, |number: f64| number;
    u32, U32, f64::from, |number: f64| number as u32;
    i32, I32, f64::from, |number: f64| number as i32;
    bool, Bool, |value: bool| f64::from(u8::from(value)), |number: f64| number != 0.0;
}

macro_rules! vectors {
    ($trait:ident, $word:ty: $($type:ty, $size:literal, $scalar:ident, $element:ty;)*) => {$(
        impl $trait for $type {
            fn shape() -> Shape { Shape::Vector($size, Scalar::$scalar) }
            fn write(&self, words: &mut Vec<$word>) {
                for component in <[$element; $size]>::from(*self) {
                    $trait::write(&component, words);
                }
            }
            fn read(words: &mut &[$word]) -> Self {
                <$type>::from(std::array::from_fn::<$element, $size, _>(|_| <$element as $trait>::read(words)))
            }
        }
    )*};
}

vectors! { Value, u32:
    Vec2, 2, F32, f32; Vec3, 3, F32, f32; Vec4, 4, F32, f32;
    IVec2, 2, I32, i32; IVec3, 3, I32, i32; IVec4, 4, I32, i32;
    UVec2, 2, U32, u32; UVec3, 3, U32, u32; UVec4, 4, U32, u32;
    BVec2, 2, Bool, bool; BVec3, 3, Bool, bool; BVec4, 4, Bool, bool;
}

vectors! { Exact, f64:
    DVec2, 2, F32, f64; DVec3, 3, F32, f64; DVec4, 4, F32, f64;
    IVec2, 2, I32, i32; IVec3, 3, I32, i32; IVec4, 4, I32, i32;
    UVec2, 2, U32, u32; UVec3, 3, U32, u32; UVec4, 4, U32, u32;
    BVec2, 2, Bool, bool; BVec3, 3, Bool, bool; BVec4, 4, Bool, bool;
}

macro_rules! matrices {
    ($trait:ident, $word:ty: $($type:ty, $size:literal, $element:ty;)*) => {$(
        impl $trait for $type {
            fn shape() -> Shape { Shape::Matrix($size, $size) }
            fn write(&self, words: &mut Vec<$word>) {
                for column in self.to_cols_array_2d() {
                    for component in column {
                        $trait::write(&component, words);
                    }
                }
            }
            fn read(words: &mut &[$word]) -> Self {
                Self::from_cols_array(&std::array::from_fn(|_| <$element as $trait>::read(words)))
            }
        }
    )*};
}

matrices! { Value, u32: Mat2, 2, f32; Mat3, 3, f32; Mat4, 4, f32; }
matrices! { Exact, f64: DMat2, 2, f64; DMat3, 3, f64; DMat4, 4, f64; }

macro_rules! arrays {
    ($trait:ident, $word:ty) => {
        impl<T: $trait, const N: usize> $trait for [T; N] {
            fn shape() -> Shape {
                Shape::Array(Box::new(T::shape()), u32::try_from(N).expect("an array that fits WGSL"))
            }
            fn write(&self, words: &mut Vec<$word>) {
                self.iter().for_each(|element| $trait::write(element, words));
            }
            fn read(words: &mut &[$word]) -> Self {
                std::array::from_fn(|_| T::read(words))
            }
        }
    };
}

arrays!(Value, u32);
arrays!(Exact, f64);

/// The arguments of a function: a tuple of values.
pub trait Arguments<T>: Sized {
    /// Returns the shape of each argument.
    fn shapes() -> Vec<Shape>;
    /// Appends the words of all arguments.
    fn write(&self, words: &mut Vec<T>);
    /// Reads the arguments and removes their words from the front.
    fn read(words: &mut &[T]) -> Self;
}

/// A function that takes a tuple's members as its arguments.
pub trait Function<A, R> {
    /// Calls the function.
    fn call(&self, arguments: A) -> R;
}

macro_rules! tuples {
    ($($name:ident)*) => {
        tuples!(@arguments Value, u32, $($name)*);
        tuples!(@arguments Exact, f64, $($name)*);

        impl<F, R, $($name,)*> Function<($($name,)*), R> for F
        where
            F: Fn($($name),*) -> R,
        {
            #[allow(non_snake_case)]
            fn call(&self, ($($name,)*): ($($name,)*)) -> R {
                self($($name),*)
            }
        }
    };
    (@arguments $trait:ident, $word:ty, $($name:ident)*) => {
        impl<$($name: $trait),*> Arguments<$word> for ($($name,)*) {
            fn shapes() -> Vec<Shape> { vec![$(<$name as $trait>::shape()),*] }
            #[allow(non_snake_case)]
            fn write(&self, words: &mut Vec<$word>) {
                let ($($name,)*) = self;
                $($trait::write($name, words);)*
            }
            fn read(words: &mut &[$word]) -> Self { ($(<$name as $trait>::read(words),)*) }
        }
    };
}

tuples!(A);
tuples!(A B);
tuples!(A B C);
tuples!(A B C D);
tuples!(A B C D E);
tuples!(A B C D E G);
tuples!(A B C D E G H);
tuples!(A B C D E G H I);

/// Lets your struct stand for the WGSL struct of the same name. List its members in the WGSL
/// struct's order; their types are inferred and checked against naga's reflection. The struct must
/// belong to the calling crate; wrap a library's struct in one of the same name.
///
/// ```
/// use glam::{DVec3, Vec3};
/// use lapidary_assay::mirror_struct;
///
/// #[derive(Clone, Debug)]
/// struct Hit {
///     direction: Vec3,
///     total: bool,
/// }
/// mirror_struct!(Hit { direction, total });
///
/// // A mirror's struct with its oracle's.
/// struct Ray {
///     origin: Vec3,
/// }
/// struct ExactRay {
///     origin: DVec3,
/// }
/// mirror_struct!(Ray, exact ExactRay { origin });
/// ```
///
/// `mirror_struct!(crate, Hit { … })` covers both `crate::Hit` and `crate::oracle::Hit`.
#[macro_export]
macro_rules! mirror_struct {
    ($name:ident { $($field:ident),* $(,)? }) => {
        $crate::mirror_struct!(@one Value, u32, $name, $name { $($field),* });
    };
    ($name:ident, exact $exact:path { $($field:ident),* $(,)? }) => {
        $crate::mirror_struct!(@one Value, u32, $name, $name { $($field),* });
        $crate::mirror_struct!(@one Exact, f64, $exact, $name { $($field),* });
    };
    ($krate:ident, $name:ident { $($field:ident),* $(,)? }) => {
        $crate::mirror_struct!(@one Value, u32, $krate::$name, $name { $($field),* });
        $crate::mirror_struct!(@one Exact, f64, $krate::oracle::$name, $name { $($field),* });
    };
    (@one $trait:ident, $word:ty, $type:path, $name:ident { $($field:ident),* }) => {
        impl $crate::value::$trait for $type {
            fn shape() -> $crate::shape::Shape {
                // Never called: its signature alone gives the type of a member.
                fn of<S, T: $crate::value::$trait>(_: impl Fn(&S) -> &T) -> $crate::shape::Shape {
                    <T as $crate::value::$trait>::shape()
                }
                $crate::shape::Shape::Struct(
                    stringify!($name).to_owned(),
                    vec![$((stringify!($field).to_owned(), of(|value: &$type| &value.$field))),*],
                )
            }
            fn write(&self, words: &mut Vec<$word>) {
                $($crate::value::$trait::write(&self.$field, words);)*
            }
            fn read(words: &mut &[$word]) -> Self {
                Self { $($field: $crate::value::$trait::read(words)),* }
            }
        }
    };
}
