//! `wgsl/proxy_geometry.wgsl`, function by function, on the device: `cargo test -p lapidary-proxy_geometry`.

use lapidary_proxy_geometry::formulas::formulas;

fn main() -> std::process::ExitCode {
    lapidary_assay::module::test(include_str!("../../../wgsl/proxy_geometry.wgsl"), formulas())
}
