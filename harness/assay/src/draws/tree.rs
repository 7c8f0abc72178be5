//! Trees of values that proptest shrinks.

use proptest::strategy::ValueTree;
use std::sync::Arc;

/// A failing value on its way to a simpler one.
pub type Tree<T> = Box<dyn ValueTree<Value = T>>;
/// Makes the tree of a row of a run.
pub(super) type MakeTree<T> = Arc<dyn Fn(Seed) -> Tree<T> + Send + Sync>;
/// Draws that seed proptest's generator: 256 bits.
pub(super) type Seed = [u32; 8];
