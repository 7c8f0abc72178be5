//! The program `take`, beside `cook`.

use lapidary_testing::program::{cook, folder, run};
use std::path::Path;

/// The program of one who only copies gives what `cook` gives.
#[test]
fn the_small_program_copies_and_lists_the_same() {
    let take = Path::new(env!("CARGO_BIN_EXE_take"));
    for words in [
        "copy fresnel refraction",
        "copy fresnel --to hlsl",
        "copy gem --effects dispersion",
        "copy --help",
        "copy frenel",
        "list",
        "list --json",
        "list --markdown",
    ] {
        let words: Vec<&str> = words.split(' ').collect();
        let (small, whole) = (run(take, folder().path(), &words, &[]), cook(folder().path(), &words));
        assert_eq!((small.code, &small.stderr), (whole.code, &whole.stderr), "{words:?}");
        assert!(small.stdout == whole.stdout, "{words:?}: {} and {}", small.stdout, whole.stdout);
    }
}
