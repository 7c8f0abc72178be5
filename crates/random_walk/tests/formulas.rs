//! `wgsl/random_walk.wgsl`, function by function, on the device: `cargo test -p lapidary-random_walk`.

use lapidary_random_walk::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/random_walk.wgsl"), formulas())
}
