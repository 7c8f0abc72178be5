//! `wgsl/random_walk.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-random_walk`.

use lapidary_random_walk::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/random_walk.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/random_walk.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
