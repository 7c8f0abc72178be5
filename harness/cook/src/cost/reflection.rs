//! Total internal reflection at the first hit inside the stone: exact and with the proxy, by how
//! normals were averaged and how the table was triangulated.

use super::CostError;
use lapidary_plan::{Geometry, Rung, Spectrum};
use lapidary_render::Settings;
use lapidary_render::pixel::{Shading, Stone, Viewer};
use lapidary_scene::cuts::{BrilliantParameters, round_brilliant};
use lapidary_scene::polyhedron::Triangulation;
use lapidary_scene::{Averaging, Scene};
use serde::{Deserialize, Serialize};

/// Width and height of the grid of rays.
const SIDE: u32 = 128;

/// The fraction of rays that are totally reflected by the first facet they hit inside the stone.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Reflection {
    /// `exact`, or how the proxy's mesh was made.
    pub mesh: String,
    /// Fraction of the rays that enter through the table, 0 to 1.
    pub table: f64,
    /// Fraction of the rays that enter through the crown's other facets, 0 to 1.
    pub crown: f64,
}

/// Measures the brilliant, seen face-up.
pub(super) fn measure() -> Result<Vec<Reflection>, CostError> {
    let scene = Scene::named("brilliant")?.seen_from(0.0, 0.0);
    let mut found = vec![share(&scene, Geometry::Convex, "exact".to_owned())?];
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
            found.push(share(&scene, Geometry::Proxy, mesh)?);
        }
    }
    Ok(found)
}

fn share(scene: &Scene, geometry: Geometry, mesh: String) -> Result<Reflection, CostError> {
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
    let [table, crown] = counts.map(|[total, all]| total as f64 / all.max(1) as f64);
    Ok(Reflection { mesh, table, crown })
}
