//! The translucent sphere: how close the curvature-dependent reflectance comes to random walks, and
//! with which width.

mod fit;
mod page;
pub mod plot;
mod rule;
mod table;

pub use rule::{Choice, Law};

pub use fit::{Fit, Form};
use lapidary_reference::random_walk::{Profile, half_space, profile};
use serde::{Deserialize, Serialize};

/// Single-scattering albedos.
pub const ALBEDOS: [f64; 4] = [0.8, 0.9, 0.99, 1.0];
/// Radii in mean free paths.
pub const RADII: [f64; 10] = [2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 100.0];
/// The reflectance functions, the plain cosine first.
pub const FORMS: [Form; 3] = [Form::Lambert, Form::Circular, Form::Spherical];

/// The factor of a reflectance function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ScaleKind {
    /// The best-fit factor: a separate exposure for each sphere.
    Free,
    /// The diffuse albedo of the half space, which can be measured on a flat sample and is the
    /// limit for large spheres.
    Fixed,
}

impl ScaleKind {
    /// Both kinds.
    pub const ALL: [Self; 2] = [Self::Free, Self::Fixed];

    /// Returns the fixed factor for a single-scattering albedo; `None` if the factor is free.
    pub(super) fn of(self, albedo: f64) -> Option<f64> {
        (self == Self::Fixed).then(|| half_space::diffuse_albedo(albedo))
    }
}

/// The best fit of a form to a sphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Single-scattering albedo.
    pub albedo: f64,
    /// Radius in mean free paths.
    pub radius: f64,
    /// The fitted reflectance function.
    pub form: Form,
    /// Whether the scale is fitted too.
    pub scale_kind: ScaleKind,
    /// Best-fit width in radians.
    pub sigma: f64,
    /// Width times radius in mean free paths; it would equal `sigma0` if the paper's rule held.
    pub sigma_radius: f64,
    /// Standard error of `sigma_radius` from the statistics of the walks; `None` if they do not
    /// determine a width.
    pub sigma_radius_error: Option<f64>,
    /// Factor of the reflectance function.
    pub scale: f64,
    /// RMS difference over the sphere's surface, divided by the irradiance of a surface that faces
    /// the light.
    pub residual: f64,
}

/// The limit of an infinite radius, where nothing is left to blur: from the closed form, without
/// walks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Single-scattering albedo.
    pub albedo: f64,
    /// Diffuse albedo of the half space.
    pub diffuse_albedo: f64,
    /// Best-fit width of the circular form with a free scale, in radians; not 0, although nothing
    /// is blurred.
    pub sigma: f64,
    /// Residual of the circular form.
    pub residual: f64,
    /// Residual of the clamped cosine: a half space does not follow Lambert's law.
    pub lambert: f64,
}

/// Spheres, simulated by random walks and fitted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SphereReport {
    /// Number of walks per sphere.
    pub walks: u64,
    /// Seed of the walks.
    pub seed: u64,
    /// Exitance profile of each sphere.
    pub profiles: Vec<Profile>,
    /// Best fit of each form and kind of scale to each sphere: scattered light only.
    pub rows: Vec<Row>,
    /// Best fits to all light, including unscattered light.
    pub rows_with_unscattered: Vec<Row>,
    /// The limits of an infinite radius.
    pub limits: Vec<Limit>,
    /// Laws for the width as a function of the radius: scattered light only.
    pub laws: Vec<Law>,
    /// Laws for all light, including unscattered light.
    pub laws_with_unscattered: Vec<Law>,
    /// Choices of one width times radius for a whole range of radii.
    pub choices: Vec<Choice>,
}

/// Simulates spheres of all [`RADII`] and [`ALBEDOS`] and fits them. `progress` receives the
/// current step, the work done and the total.
pub fn run(walks: u64, seed: u64, progress: &mut dyn FnMut(&'static str, u64, u64)) -> SphereReport {
    let total = (ALBEDOS.len() * RADII.len()) as u64;
    let mut profiles = Vec::new();
    for albedo in ALBEDOS {
        for radius in RADII {
            let number = profiles.len() as u64;
            progress("walking", number, total);
            // Each sphere has its own seed, so that the noise of different spheres is independent.
            profiles.push(profile(radius, albedo, walks, seed.wrapping_add(number)));
        }
    }
    progress("fitting", total, total);
    SphereReport::of(walks, seed, profiles)
}

impl SphereReport {
    /// Fits the profiles from random walks.
    pub fn of(walks: u64, seed: u64, profiles: Vec<Profile>) -> Self {
        let (mut rows, mut rows_with_unscattered) = (Vec::new(), Vec::new());
        let mut limits = Vec::new();
        let mut choices = Vec::new();
        let mut albedos: Vec<f64> = profiles.iter().map(|profile| profile.albedo).collect();
        albedos.dedup();
        for &albedo in &albedos {
            for profile in profiles.iter().filter(|profile| profile.albedo == albedo) {
                rows.extend(fits(profile));
                rows_with_unscattered.extend(fits(&profile.with_unscattered()));
            }
            limits.push(limit(albedo));
        }
        let laws = rule::laws(&albedos, &rows);
        let laws_with_unscattered = rule::laws(&albedos, &rows_with_unscattered);
        for &albedo in &albedos {
            choices.extend(rule::choices(albedo, &profiles, &rows, &laws));
        }
        Self { walks, seed, profiles, rows, rows_with_unscattered, limits, laws, laws_with_unscattered, choices }
    }

    /// Returns the sphere with that albedo and radius.
    pub fn profile(&self, albedo: f64, radius: f64) -> Option<&Profile> {
        self.profiles.iter().find(|profile| profile.albedo == albedo && profile.radius == radius)
    }

    /// Returns a form's best fit to the sphere with that albedo and radius.
    pub fn row(&self, albedo: f64, radius: f64, form: Form, kind: ScaleKind) -> Option<&Row> {
        self.best(albedo, form, kind).find(|row| row.radius == radius)
    }

    /// Returns the best fits of a form and a kind of scale for an albedo, by radius, to all light.
    pub fn best_with_unscattered(&self, albedo: f64, form: Form, kind: ScaleKind) -> impl Iterator<Item = &Row> {
        rows_of(&self.rows_with_unscattered, albedo, form, kind)
    }

    /// Returns the best fits of a form and a kind of scale for an albedo, by radius, to scattered
    /// light.
    pub fn best(&self, albedo: f64, form: Form, kind: ScaleKind) -> impl Iterator<Item = &Row> {
        rows_of(&self.rows, albedo, form, kind)
    }

    /// Returns the report as text.
    pub fn text(&self) -> String {
        table::text(self)
    }
}

fn rows_of(rows: &[Row], albedo: f64, form: Form, kind: ScaleKind) -> impl Iterator<Item = &Row> {
    rows.iter().filter(move |row| row.albedo == albedo && row.form == form && row.scale_kind == kind)
}

fn fits(profile: &Profile) -> Vec<Row> {
    let &Profile { albedo, radius, .. } = profile;
    let fit = |scale_kind: ScaleKind, form: Form| {
        let fixed = scale_kind.of(albedo);
        let fit @ Fit { sigma, scale, residual } = Fit::best(profile, form, fixed);
        let sigma_radius_error = fit.sigma_error(profile, form, fixed).map(|error| error * radius);
        Row {
            albedo,
            radius,
            form,
            scale_kind,
            sigma,
            sigma_radius: sigma * radius,
            sigma_radius_error,
            scale,
            residual,
        }
    };
    ScaleKind::ALL.into_iter().flat_map(|kind| FORMS.map(|form| fit(kind, form))).collect()
}

fn limit(albedo: f64) -> Limit {
    let profile = half_space::profile(albedo);
    let Fit { sigma, residual, .. } = Fit::best(&profile, Form::Circular, None);
    let lambert = Fit::best(&profile, Form::Lambert, None).residual;
    Limit { albedo, diffuse_albedo: profile.whole(), sigma, residual, lambert }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report() -> SphereReport {
        let profiles = [2.0, 5.0, 10.0, 20.0, 50.0].map(|radius| profile(radius, 0.99, 20_000, radius as u64));
        SphereReport::of(20_000, 1, profiles.to_vec())
    }

    #[test]
    fn every_sphere_has_each_form_and_scale_once() {
        let report = report();
        assert_eq!(report.rows.len(), 5 * 6);
        for form in FORMS {
            for kind in ScaleKind::ALL {
                let rows: Vec<&Row> = report.best(0.99, form, kind).collect();
                assert_eq!(rows.iter().map(|row| row.radius).collect::<Vec<_>>(), [2.0, 5.0, 10.0, 20.0, 50.0]);
                for row in rows {
                    assert_eq!(row.sigma_radius, row.sigma * row.radius);
                    // Chandrasekhar's diffuse albedo for this single-scattering albedo.
                    let fixed = (row.scale - 0.794564).abs() < 6e-7;
                    assert_eq!(fixed, kind == ScaleKind::Fixed, "{row:?}");
                }
            }
        }
    }

    #[test]
    fn more_freedom_leaves_less_over() {
        let report = report();
        let residuals = |form, kind| report.best(0.99, form, kind).map(|row: &Row| row.residual).collect::<Vec<f64>>();
        for form in FORMS {
            let (free, fixed) = (residuals(form, ScaleKind::Free), residuals(form, ScaleKind::Fixed));
            assert!(free.iter().zip(&fixed).all(|(free, fixed)| *free <= fixed + 1e-9), "{form:?} {free:?} {fixed:?}");
            for kind in ScaleKind::ALL {
                let (found, lambert) = (residuals(form, kind), residuals(Form::Lambert, kind));
                assert!(found.iter().zip(&lambert).all(|(found, lambert)| found <= lambert), "{form:?} {kind:?}");
            }
        }
        // For a small sphere the width improves the fit a lot.
        let [found, lambert] = [Form::Circular, Form::Lambert].map(|form| residuals(form, ScaleKind::Free)[0]);
        assert!(5.0 * found < lambert, "{found} {lambert}");
    }

    #[test]
    fn a_report_survives_its_json() {
        let report = report();
        let json = serde_json::to_string(&report).expect("JSON");
        let again: SphereReport = serde_json::from_str(&json).expect("a report");
        assert_eq!(again.text(), report.text());
        assert_eq!(again.profiles.len(), 5);
        for (again, before) in again.rows.iter().zip(&report.rows) {
            assert_eq!((again.form, again.scale_kind), (before.form, before.scale_kind));
            assert_eq!(again.sigma_radius_error.is_some(), before.sigma_radius_error.is_some());
            assert!((again.sigma / before.sigma - 1.0).abs() < 1e-12 || again.sigma == before.sigma);
        }
        // An interval is missing.
        let short = json.replacen("\"exitance\":[", "\"exitance\":[],\"gone\":[", 1);
        let error = serde_json::from_str::<SphereReport>(&short).expect_err("no interval at all").to_string();
        assert!(error.contains("a value for each interval"), "{error}");
    }

    /// With unscattered light a small sphere needs a wider function; a large one, through which no
    /// light passes unscattered, does not.
    #[test]
    fn what_goes_straight_through_widens_small_spheres_alone() {
        let report = report();
        let widths = |rows: Vec<&Row>| rows.iter().map(|row| row.sigma_radius).collect::<Vec<f64>>();
        let kind = ScaleKind::Free;
        let scattered = widths(report.best(0.99, Form::Circular, kind).collect());
        let all = widths(report.best_with_unscattered(0.99, Form::Circular, kind).collect());
        assert_eq!((scattered.len(), all.len()), (5, 5));
        assert!(all[0] > 1.1 * scattered[0] && (all[4] / scattered[4] - 1.0).abs() < 0.02, "{scattered:?} {all:?}");
    }

    /// If sigma = sigma_0 / R held, sigma R would be the same for all radii of a material. It is
    /// not.
    #[test]
    fn the_best_width_is_not_inverse_to_the_radius() {
        let report = report();
        let rows: Vec<&Row> = report.best(0.99, Form::Circular, ScaleKind::Free).collect();
        // Smaller spheres are wider: that much is true.
        assert!(rows.windows(2).all(|pair| pair[0].sigma > pair[1].sigma), "{rows:?}");
        assert!(rows.windows(2).all(|pair| pair[0].sigma_radius < pair[1].sigma_radius), "{rows:?}");
        let drift = rows[4].sigma_radius / rows[0].sigma_radius;
        assert!((2.2..2.9).contains(&drift), "{drift}");
    }
}
