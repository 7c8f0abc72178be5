//! The glTF loader on thousands of broken files.

use lapidary_harness::scene::fuzz::{SUITE_CASES, run};

#[test]
fn the_loader_survives_broken_files() {
    let tally = run(SUITE_CASES).unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!(tally.loaded + tally.refused, SUITE_CASES);
    // Were all files refused at the first check, or none broken at all, nothing would be tested.
    assert!(tally.loaded > SUITE_CASES / 20 && tally.refused > SUITE_CASES / 4, "{tally:?}");
}
