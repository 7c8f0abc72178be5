//! Filters: what attributes were turned into before they were compressed.

/// A filter by its name in the extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Filter {
    None,
    /// Unit vectors on an octahedron.
    Octahedral,
    /// Quaternions without their greatest component.
    Quaternion,
    /// Floats by a mantissa of 24 and an exponent of 8 bits.
    Exponential,
    /// Colours by a luma and two differences.
    Color,
}

impl Filter {
    pub(super) fn of(name: &str) -> Option<Self> {
        match name {
            "NONE" => Some(Self::None),
            "OCTAHEDRAL" => Some(Self::Octahedral),
            "QUATERNION" => Some(Self::Quaternion),
            "EXPONENTIAL" => Some(Self::Exponential),
            "COLOR" => Some(Self::Color),
            _ => None,
        }
    }

    /// Whether elements of `stride` bytes can have gone through it.
    pub(super) fn fits(self, stride: u64) -> bool {
        match self {
            Self::None | Self::Exponential => stride.is_multiple_of(4),
            Self::Octahedral | Self::Color => stride == 4 || stride == 8,
            Self::Quaternion => stride == 8,
        }
    }

    /// Turns the elements back, in place.
    pub(super) fn undo(self, elements: &mut [u8], stride: usize) {
        match (self, stride) {
            (Self::None, _) => {}
            (Self::Octahedral, 4) => bytes(elements, |of| direction(of.map(|x| f32::from(x as i8)), 127.0)),
            (Self::Octahedral, _) => shorts(elements, |of| direction(of.map(|x| f32::from(x as i16)), 32767.0)),
            (Self::Quaternion, _) => shorts(elements, quaternion),
            (Self::Exponential, _) => {
                for number in elements.as_chunks_mut::<4>().0 {
                    let bits = i32::from_le_bytes(*number);
                    let (mantissa, exponent) = (bits << 8 >> 8, bits >> 24);
                    // A product of doubles, so that it is rounded once.
                    *number = ((f64::from(mantissa) * f64::from(exponent).exp2()) as f32).to_le_bytes();
                }
            }
            (Self::Color, 4) => bytes(elements, |[y, co, cg, a]| {
                color([i32::from(y), i32::from(co as i8), i32::from(cg as i8), i32::from(a)], 255)
            }),
            (Self::Color, _) => shorts(elements, |[y, co, cg, a]| {
                color([i32::from(y), i32::from(co as i16), i32::from(cg as i16), i32::from(a)], 65535)
            }),
        }
    }
}

/// Maps elements of four bytes; `None` leaves a component as it is.
fn bytes(elements: &mut [u8], map: impl Fn([u8; 4]) -> [Option<f32>; 4]) {
    for element in elements.as_chunks_mut::<4>().0 {
        let mapped = map(*element);
        for (component, number) in element.iter_mut().zip(mapped) {
            // Numbers with a sign are stored in two's complement.
            *component = number.map_or(*component, |number| number.round() as i32 as u8);
        }
    }
}

/// Maps elements of four shorts; `None` leaves a component as it is.
fn shorts(elements: &mut [u8], map: impl Fn([u16; 4]) -> [Option<f32>; 4]) {
    for element in elements.as_chunks_mut::<8>().0 {
        let old = std::array::from_fn(|place| u16::from_le_bytes([element[2 * place], element[2 * place + 1]]));
        for ((bytes, number), old) in element.as_chunks_mut::<2>().0.iter_mut().zip(map(old)).zip(old) {
            *bytes = number.map_or(old, |number| number.round() as i32 as u16).to_le_bytes();
        }
    }
}

/// The unit vector, times `largest`, of a place x, y on the octahedron |x| + |y| + |z| = `one`. The fourth component is another's.
fn direction([x, y, one, _]: [f32; 4], largest: f32) -> [Option<f32>; 4] {
    let z = one - x.abs() - y.abs();
    // The lower half is folded out over the upper one's corners.
    let fold = (-z).max(0.0);
    let [x, y] = [x, y].map(|part| if part >= 0.0 { part - fold } else { part + fold });
    let length = (x * x + y * y + z * z).sqrt();
    let scaled = |part: f32| if length > 0.0 { Some(part / length * largest) } else { Some(0.0) };
    [scaled(x), scaled(y), scaled(z), None]
}

/// The unit quaternion of its three lesser components, which lie within √½; the fourth number says which is missing, and the scale.
fn quaternion(stored: [u16; 4]) -> [Option<f32>; 4] {
    let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from((stored[3] | 3) as i16);
    let [x, y, z] = [stored[0], stored[1], stored[2]].map(|part| f32::from(part as i16) * scale);
    let greatest = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let mut quaternion = [None; 4];
    for (place, part) in [greatest, x, y, z].into_iter().enumerate() {
        quaternion[(usize::from(stored[3] & 3) + place) % 4] = Some(part * 32767.0);
    }
    quaternion
}

/// The colour, in fractions of `largest`, of a luma, an orange and a green difference; the highest bit of the fourth number marks their
/// range, and those below it are alpha.
fn color([y, co, cg, a]: [i32; 4], largest: i32) -> [Option<f32>; 4] {
    let range = (a as u32 + 1).next_power_of_two() as i32 - 1;
    let alpha = a & range >> 1;
    let alpha = alpha << 1 | alpha & 1;
    let scale = largest as f32 / range.max(1) as f32;
    let stored = |number: i32| Some((number as f32 * scale).clamp(0.0, largest as f32));
    [stored(y + co - cg), stored(y + cg), stored(y - co - cg), stored(alpha)]
}
