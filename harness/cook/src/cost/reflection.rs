//! Total internal reflection at the first hit inside: what the exact stone has, and what the proxy makes of it, by how normals were
//! averaged and how the table was cut into triangles.

use super::CostError;
use lapidary_plan::{Geometry, Rung, Spectrum};
use lapidary_render::Settings;
use lapidary_render::pixel::{Shading, Stone, Viewer};
use lapidary_scene::cuts::{BrilliantParameters, round_brilliant};
use lapidary_scene::polyhedron::Triangulation;
use lapidary_scene::{Averaging, Scene};
use serde::{Deserialize, Serialize};

/// Side of the grid of rays.
const SIDE: u32 = 128;

/// The share of rays through the stone that the first facet reflects totally.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Reflection {
    /// `exact`, or how the proxy's mesh was made.
    pub mesh: String,
    /// Of the rays that enter by the table.
    pub table: f64,
    /// Of those that enter by the crown's other facets.
    pub crown: f64,
}

/// The brilliant face-up.
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
    // Totally reflected and all, by the table and by the rest of the crown.
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
