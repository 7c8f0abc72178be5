//! The translucent sphere: how near the curvature-dependent reflectance comes to what random walks give, and with which width.

mod fit;
mod page;
pub mod plot;
mod rule;
mod table;

pub use rule::{Choice, Law};

pub use fit::{Fit, Form};
use lapidary_reference::random_walk::{Profile, half_space, profile};
use serde::{Deserialize, Serialize};

/// Albedos of one scattering.
pub const ALBEDOS: [f64; 4] = [0.8, 0.9, 0.99, 1.0];
/// Radii in mean free paths.
pub const RADII: [f64; 10] = [2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 100.0];
/// The forms, the plain cosine first.
pub const FORMS: [Form; 3] = [Form::Lambert, Form::Circular, Form::Spherical];

/// What a reflectance function is multiplied by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ScaleKind {
    /// What brings it nearest: an exposure of its own for each sphere.
    Free,
    /// The half space's diffuse albedo, which is what one measures on a flat sample and what a large sphere comes to.
    Fixed,
}

impl ScaleKind {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Free, Self::Fixed];

    /// The scale for an albedo of one scattering, where it is given.
    pub(super) fn of(self, albedo: f64) -> Option<f64> {
        (self == Self::Fixed).then(|| half_space::diffuse_albedo(albedo))
    }
}

/// The best of a form beside a sphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Of one scattering.
    pub albedo: f64,
    /// In mean free paths.
    pub radius: f64,
    /// What is fitted.
    pub form: Form,
    /// Whether the scale is fitted too.
    pub scale_kind: ScaleKind,
    /// The best width, in radians.
    pub sigma: f64,
    /// Width times radius, in mean free paths: `sigma0`, were the paper's rule true.
    pub sigma_radius: f64,
    /// Its standard error by the walks' statistics; none where they settle no width.
    pub sigma_radius_error: Option<f64>,
    /// What the function is multiplied by.
    pub scale: f64,
    /// RMS of the difference over the sphere's surface, over the irradiance of a surface that faces the light.
    pub residual: f64,
}

/// An infinite radius, where nothing is left to blur: from the closed form, without walks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Of one scattering.
    pub albedo: f64,
    /// The half space's diffuse albedo.
    pub diffuse_albedo: f64,
    /// The width that the circular form takes all the same, with a free scale.
    pub sigma: f64,
    /// Its residual.
    pub residual: f64,
    /// That of the clamped cosine: a half space does not reflect as Lambert has it.
    pub lambert: f64,
}

/// Spheres, walked through and fitted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SphereReport {
    /// Walks through each sphere.
    pub walks: u64,
    /// Their seed.
    pub seed: u64,
    /// What leaves each sphere.
    pub profiles: Vec<Profile>,
    /// The best of each form and kind of scale beside each: of the light that was scattered.
    pub rows: Vec<Row>,
    /// The same of all light, that which went straight through with it.
    pub rows_with_unscattered: Vec<Row>,
    /// Infinite radii.
    pub limits: Vec<Limit>,
    /// How the width goes with the radius, of scattered light.
    pub laws: Vec<Law>,
    /// The same of all light.
    pub laws_with_unscattered: Vec<Law>,
    /// One width times radius for a whole range of radii.
    pub choices: Vec<Choice>,
}

/// Walks through spheres of all [`RADII`] and [`ALBEDOS`] and fits. `progress` is told what is done, and how much of it.
pub fn run(walks: u64, seed: u64, progress: &mut dyn FnMut(&'static str, u64, u64)) -> SphereReport {
    let total = (ALBEDOS.len() * RADII.len()) as u64;
    let mut profiles = Vec::new();
    for albedo in ALBEDOS {
        for radius in RADII {
            let number = profiles.len() as u64;
            progress("walking", number, total);
            // Each sphere has walks of its own, so that their chances do not go together.
            profiles.push(profile(radius, albedo, walks, seed.wrapping_add(number)));
        }
    }
    progress("fitting", total, total);
    SphereReport::of(walks, seed, profiles)
}

impl SphereReport {
    /// Fits what walks gave.
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

    /// The sphere of that albedo and radius.
    pub fn profile(&self, albedo: f64, radius: f64) -> Option<&Profile> {
        self.profiles.iter().find(|profile| profile.albedo == albedo && profile.radius == radius)
    }

    /// A form's best beside the sphere of that albedo and radius.
    pub fn row(&self, albedo: f64, radius: f64, form: Form, kind: ScaleKind) -> Option<&Row> {
        self.best(albedo, form, kind).find(|row| row.radius == radius)
    }

    /// The same of all light.
    pub fn best_with_unscattered(&self, albedo: f64, form: Form, kind: ScaleKind) -> impl Iterator<Item = &Row> {
        rows_of(&self.rows_with_unscattered, albedo, form, kind)
    }

    /// The rows of a form and a kind of scale for an albedo, by radius.
    pub fn best(&self, albedo: f64, form: Form, kind: ScaleKind) -> impl Iterator<Item = &Row> {
        rows_of(&self.rows, albedo, form, kind)
    }

    /// For people.
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
                    // Chandrasekhar's, for this albedo.
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
        // Where the sphere is small, it buys a lot.
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
        // One interval too few.
        let short = json.replacen("\"exitance\":[", "\"exitance\":[],\"gone\":[", 1);
        let error = serde_json::from_str::<SphereReport>(&short).expect_err("no interval at all").to_string();
        assert!(error.contains("a value for each interval"), "{error}");
    }

    /// Of all light a small sphere wants a wider function, and a large one, through which nothing goes straight, the same.
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

    /// Were sigma = sigma_0 / R true, sigma R were one number for a matter. It is not.
    #[test]
    fn the_best_width_is_not_inverse_to_the_radius() {
        let report = report();
        let rows: Vec<&Row> = report.best(0.99, Form::Circular, ScaleKind::Free).collect();
        // The smaller the sphere, the wider: so much is true.
        assert!(rows.windows(2).all(|pair| pair[0].sigma > pair[1].sigma), "{rows:?}");
        assert!(rows.windows(2).all(|pair| pair[0].sigma_radius < pair[1].sigma_radius), "{rows:?}");
        let drift = rows[4].sigma_radius / rows[0].sigma_radius;
        assert!((2.2..2.9).contains(&drift), "{drift}");
    }
}
