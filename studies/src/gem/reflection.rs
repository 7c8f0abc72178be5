//! Total internal reflection at the first hit inside the stone: exact and with the proxy, by how
//! normals were averaged and how the table was triangulated.

use lapidary_ladders::{CostError, Report, Row};
use lapidary_plan::{Geometry, Rung, Spectrum};
use lapidary_render::Settings;
use lapidary_render::pixel::{Shading, Stone, Viewer};
use lapidary_scene::cuts::{BrilliantParameters, round_brilliant};
use lapidary_scene::polyhedron::Triangulation;
use lapidary_scene::{Averaging, Scene};

/// Width and height of the grid of rays.
const SIDE: u32 = 128;

/// The parts of the stone that rays enter through.
pub(super) const PARTS: [&str; 2] = ["table", "crown"];

/// Adds, for the brilliant seen face-up, the fraction of the rays that the first facet they hit
/// inside reflects totally: exactly, and with the proxy by how its mesh was made.
pub(super) fn measure(report: &mut Report) -> Result<(), CostError> {
    let scene = Scene::named("brilliant")?.seen_from(0.0, 0.0);
    let mut add = |mesh: &str, shares: [f64; 2]| {
        let rows = PARTS.into_iter().zip(shares).map(|(part, share)| Row::new(mesh, part, "reflected", share, ""));
        report.rows.extend(rows);
    };
    add("exact", shares(&scene, Geometry::Convex)?);
    let stone = round_brilliant(&BrilliantParameters::TOLKOWSKY).map_err(lapidary_scene::SceneError::from)?;
    let averagings = [("angle", Averaging::Angle), ("area", Averaging::Area), ("plain", Averaging::Plain)];
    let triangulations = [
        ("from the centre", Triangulation::Centroid),
        ("fan", Triangulation::Fan),
        ("strip", Triangulation::Strip),
        ("slivers", Triangulation::Sliver),
    ];
    for (averaging_name, averaging) in averagings {
        for (name, triangulation) in triangulations {
            let mut scene = scene.clone();
            scene.objects[0].mesh = stone.to_mesh_with(averaging, triangulation);
            let mesh = format!("proxy, normals by {averaging_name}, table {name}");
            add(&mesh, shares(&scene, Geometry::Proxy)?);
        }
    }
    Ok(())
}

/// Returns the fractions for [`PARTS`].
fn shares(scene: &Scene, geometry: Geometry) -> Result<[f64; 2], CostError> {
    let rung = Rung::Inside { geometry, hits: 1, spectrum: Spectrum::One };
    let settings = Settings { rung, samples: 1, ..Settings::of_size(SIDE, SIDE) };
    let object = &scene.objects[0];
    let (viewer, shading) = (Viewer::new(scene, SIDE, SIDE), Shading::new(&object.material, &settings));
    let stone = Stone::new(object, &settings)?;
    let top = scene.bounds().max.y;
    // Counts of totally reflected rays and of all rays, for the table and for the rest of the
    // crown.
    let mut counts = [[0usize; 2]; 2];
    for (row, column) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column))) {
        let seen = viewer.see(&object.mesh, f64::from(column) + 0.5, f64::from(row) + 0.5);
        let Some(seen) = seen else { continue };
        let pixel = shading.pixel(&stone, seen, scene.camera.eye);
        let Some(event) = pixel.rays.first().and_then(|ray| ray.first()) else { continue };
        let count = &mut counts[usize::from(seen.position.y < top - 1e-4)];
        count[0] += usize::from(event.total != 0);
        count[1] += 1;
    }
    Ok(counts.map(|[total, all]| total as f64 / all.max(1) as f64))
}
