//! Random numbers that are the same on any number of threads.

use rand::SeedableRng as _;
use rand::rngs::Xoshiro256PlusPlus;

/// Returns the generator of a batch.
pub(crate) fn generator(seed: u64, batch: u64) -> Xoshiro256PlusPlus {
    // Neighbouring seeds give dissimilar states: the state is a hash of the seed.
    Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ batch)
}
