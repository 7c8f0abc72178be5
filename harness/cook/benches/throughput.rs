//! Measures the speed of the harness itself: `cargo bench --profile dev`, which reuses the build of
//! `cook`.

use lapidary_assay::property::{Check, Settings};
use lapidary_cook::check::{self, Source};
use lapidary_cook::formulas;
use lapidary_gpu::{AdapterChoice, Gpu};

/// Cases in one sample.
const CASES: u64 = 1 << 20;

fn main() {
    divan::main();
}

/// Measures property tests, including generation, shader, mirror, oracle and comparison. `item/s`
/// are cases per second.
#[divan::bench(args = ["refraction_refract", "fresnel_dielectric", "closest_point_centre"], sample_count = 5, sample_size = 1)]
fn property_cases(bencher: divan::Bencher<'_, '_>, function: &str) {
    let gpu = Gpu::shared(&AdapterChoice::from_environment()).expect("an adapter");
    let formula = formulas::of_function(function).expect("the function has a formula");
    let mut kernel = check::kernel(gpu, formula, Source::Cookbook).expect("the cookbook's WGSL compiles");
    let tolerance = check::tolerance(gpu, formula);
    bencher.counter(divan::counter::ItemsCount::new(CASES)).bench_local(|| {
        let settings = Settings { cases: CASES, ..Settings::default() };
        let report = Check { formula, runner: &mut kernel, tolerance: &tolerance }.run(settings, &[]).expect("runs");
        assert_eq!(report.failed, 0);
    });
}
