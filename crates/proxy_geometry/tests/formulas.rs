//! `wgsl/proxy_geometry.wgsl` and its naive forms, function by function, on the device: `cargo test -p lapidary-proxy_geometry`.

use lapidary_proxy_geometry::formulas::formulas;

fn main() -> std::process::ExitCode {
    let module = concat!(
        include_str!("../../../wgsl/proxy_geometry.wgsl"),
        "\n",
        include_str!("../../../wgsl/naive/proxy_geometry.wgsl")
    );
    lapidary_assay::module::test(module, formulas())
}
