//! A stream of bytes, read from its beginning.

/// What a stream lacks.
pub(super) const SHORT: &str = "it ends too early";
/// What a stream has too much.
pub(super) const LONG: &str = "it does not end with its last element";

pub(super) struct Stream<'a> {
    rest: &'a [u8],
}

impl<'a> Stream<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    pub(super) fn take(&mut self, length: usize) -> Result<&'a [u8], &'static str> {
        let (taken, rest) = self.rest.split_at_checked(length).ok_or(SHORT)?;
        self.rest = rest;
        Ok(taken)
    }

    pub(super) fn byte(&mut self) -> Result<u8, &'static str> {
        let (byte, rest) = self.rest.split_first().ok_or(SHORT)?;
        self.rest = rest;
        Ok(*byte)
    }

    /// Seven bits a byte, the lowest first; all bytes but the last have the highest bit.
    pub(super) fn number(&mut self) -> Result<u32, &'static str> {
        let mut number = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            number |= u32::from(byte & 127) << shift;
            if byte < 128 {
                return Ok(number);
            }
        }
        Err("a number of it is too long")
    }

    pub(super) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }
}
