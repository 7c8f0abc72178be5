//! Measured optical constants n and k of metals, and what a smooth surface of them reflects.
//!
//! The numbers are from the refractiveindex.info database (public domain), which names the papers.

/// Wavelength in nm, n and k, in rows of rising wavelength that reach from 400 to 700 nm.
pub(super) type Constants = &'static [[f64; 3]];

/// Gold. Johnson and Christy, "Optical constants of the noble metals", Phys. Rev. B 6, 4370, 1972.
pub(super) const GOLD: Constants = &[
    [397.4, 1.47, 1.952],
    [413.3, 1.46, 1.958],
    [430.5, 1.45, 1.948],
    [450.9, 1.38, 1.914],
    [471.4, 1.31, 1.849],
    [495.9, 1.04, 1.833],
    [520.9, 0.62, 2.081],
    [548.6, 0.43, 2.455],
    [582.1, 0.29, 2.863],
    [616.8, 0.21, 3.272],
    [659.5, 0.14, 3.697],
    [704.5, 0.13, 4.103],
];

/// Silver, by the same.
pub(super) const SILVER: Constants = &[
    [397.4, 0.05, 2.07],
    [413.3, 0.05, 2.275],
    [430.5, 0.04, 2.462],
    [450.9, 0.04, 2.657],
    [471.4, 0.05, 2.869],
    [495.9, 0.05, 3.093],
    [520.9, 0.05, 3.324],
    [548.6, 0.06, 3.586],
    [582.1, 0.05, 3.858],
    [616.8, 0.06, 4.152],
    [659.5, 0.05, 4.483],
    [704.5, 0.04, 4.838],
];

/// Copper, by the same.
pub(super) const COPPER: Constants = &[
    [397.4, 1.32, 2.116],
    [413.3, 1.28, 2.207],
    [430.5, 1.25, 2.305],
    [450.9, 1.24, 2.397],
    [471.4, 1.25, 2.483],
    [495.9, 1.22, 2.564],
    [520.9, 1.18, 2.608],
    [548.6, 1.02, 2.577],
    [582.1, 0.7, 2.704],
    [616.8, 0.3, 3.205],
    [659.5, 0.22, 3.747],
    [704.5, 0.21, 4.205],
];

/// Rhodium. Weaver, Olson and Lynch, "Optical investigation of the electronic structure of bulk Rh and Ir",
/// Phys. Rev. B 15, 4115, 1977; the numbers are from Palik, "Handbook of Optical Constants of Solids", 1985.
pub(super) const RHODIUM: Constants = &[
    [400.0, 1.41, 4.2],
    [413.3, 1.53, 4.29],
    [427.5, 1.63, 4.36],
    [459.2, 1.8, 4.49],
    [476.9, 1.85, 4.55],
    [495.9, 1.88, 4.65],
    [516.6, 1.9, 4.78],
    [539.1, 1.94, 4.94],
    [563.6, 2.0, 5.11],
    [590.4, 2.05, 5.3],
    [619.9, 2.12, 5.51],
    [652.6, 2.2, 5.76],
    [688.8, 2.3, 6.02],
    [729.3, 2.42, 6.33],
];

/// Platinum, every 20 nm. Tselin and others, "Exploring the dielectric function of platinum", Phys. Rev. B 110,
/// 195130, 2024.
pub(super) const PLATINUM: Constants = &[
    [398.6, 1.526, 3.369],
    [421.8, 1.585, 3.547],
    [445.0, 1.645, 3.724],
    [468.2, 1.705, 3.898],
    [491.4, 1.766, 4.071],
    [514.5, 1.828, 4.242],
    [537.7, 1.893, 4.411],
    [560.9, 1.959, 4.578],
    [584.1, 2.027, 4.742],
    [607.3, 2.098, 4.903],
    [630.4, 2.17, 5.062],
    [653.6, 2.243, 5.217],
    [676.8, 2.317, 5.37],
    [700.0, 2.393, 5.519],
    [701.7, 2.398, 5.529],
];

/// Austenitic stainless steel: 18.5 % chromium, 9.3 % nickel. Karlsson and Ribbing, "Optical constants and spectral
/// selectivity of stainless steel and its oxides", J. Appl. Phys. 53, 6340, 1982.
pub(super) const STEEL: Constants = &[
    [400.0, 1.5249, 2.7925],
    [420.0, 1.5762, 2.924],
    [440.0, 1.6386, 3.0555],
    [460.0, 1.7169, 3.1785],
    [480.0, 1.7921, 3.2933],
    [500.0, 1.8636, 3.401],
    [520.0, 1.9349, 3.5072],
    [540.0, 2.0072, 3.6166],
    [560.0, 2.0807, 3.7298],
    [580.0, 2.1557, 3.8451],
    [600.0, 2.2325, 3.9594],
    [620.0, 2.3122, 4.0504],
    [640.0, 2.3962, 4.1378],
    [660.0, 2.4839, 4.2261],
    [680.0, 2.5731, 4.3155],
    [700.0, 2.6617, 4.4066],
];

/// Returns the share of unpolarised light that a smooth surface reflects, at a wavelength in nm and a cosine of incidence:
/// Fresnel's, with complex index. Between two rows, n and k are interpolated linearly.
pub(super) fn reflectance(constants: Constants, nanometres: f64, cosine: f64) -> f64 {
    let next = constants.partition_point(|row| row[0] < nanometres).clamp(1, constants.len() - 1);
    let [[from, n_from, k_from], [to, n_to, k_to]] = [constants[next - 1], constants[next]];
    let share = (nanometres - from) / (to - from);
    let [n, k] = [n_from + share * (n_to - n_from), k_from + share * (k_to - k_from)];
    conductor(n, k, cosine)
}

/// Returns the reflectance at an interface from air to a conductor of index n + i k (Born and Wolf, section 14.2; in this
/// form Lagarde, "Memo on Fresnel equations", 2013).
pub(super) fn conductor(n: f64, k: f64, cosine: f64) -> f64 {
    let squared = cosine * cosine;
    let sine_squared = 1.0 - squared;
    let rest = n * n - k * k - sine_squared;
    let both = rest.hypot(2.0 * n * k);
    let real = (0.5 * (both + rest)).max(0.0).sqrt();
    let across = (both + squared - 2.0 * cosine * real) / (both + squared + 2.0 * cosine * real);
    let sum = squared * both + sine_squared * sine_squared;
    let cross = 2.0 * cosine * real * sine_squared;
    0.5 * across * (1.0 + (sum - cross) / (sum + cross))
}
