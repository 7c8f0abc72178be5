//! The rungs of the gem ladder, and what is measured of them.

/// The ladder's name.
pub const NAME: &str = "gem";

/// The measures of a rung in a view: FLIP, RMSE, energy and the change to the next frame.
pub const MEASURES: [&str; 4] = ["flip", "rmse", "energy", "change"];
/// The frame that the paper times: the brilliant fills it.
pub const FILLED: &str = "filled";

/// The ladder from cheap to exact; the number of hits doubles from rung to rung.
///
/// A rung with the paper's dispersion is also measured at its best-fit strength. The planes, the
/// hierarchy and the loop over triangles give the same pictures as the walk, so a few rungs are
/// enough to show their cost; those of the hierarchy include colours, which make it a twentieth
/// slower.
pub const RUNGS: [&str; 51] = [
    "surface",
    "proxy-0",
    "proxy-1",
    "proxy-1+paper",
    "proxy-1+tracker",
    "proxy-1+3",
    "proxy-1+31",
    "proxy-2",
    "proxy-2+paper",
    "proxy-2+tracker",
    "proxy-2+3",
    "proxy-4",
    "proxy-4+paper",
    "proxy-4+tracker",
    "proxy-4+3",
    "proxy-8",
    "proxy-8+paper",
    "proxy-8+tracker",
    "proxy-8+3",
    "proxy-8+31",
    "walk-1",
    "walk-2",
    "walk-2+paper",
    "walk-2+tracker",
    "walk-2+3",
    "walk-4",
    "walk-4+paper",
    "walk-4+tracker",
    "walk-4+split",
    "walk-4+3",
    "walk-4+31",
    "walk-8",
    "walk-8+paper",
    "walk-8+tracker",
    "walk-8+split",
    "walk-8+3",
    "walk-8+31",
    "walk-16+tracker",
    "convex-1",
    "convex-4",
    "convex-8",
    "convex-8+tracker",
    "convex-16+tracker",
    "bvh-1",
    "bvh-2+tracker",
    "bvh-4+tracker",
    "bvh-8+tracker",
    "bvh-8+3",
    "bvh-16+tracker",
    "triangles-1",
    "triangles-8+tracker",
];
