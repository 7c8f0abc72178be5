//! A stone from a .glb: its mesh, what its material says, and what `gem_walk` wants to know of its
//! facets.

use glam::{DVec3, Mat4, Quat, Vec3, Vec4};
use gltf::camera::Projection;
use lapidary_convex_trace::Facets;
use lapidary_convex_walk::{CONVEX_WALK_FACE, FacetMap};
use lapidary_dispersion::{channels, oracle};
use serde_json::Value;
use std::error::Error;

pub struct Stone {
    /// Corners in world space, and three of them per triangle.
    pub positions: Vec<Vec3>,
    pub indices: Vec<u32>,
    /// Planes about `centre`, and the one of each triangle.
    pub planes: Vec<Vec4>,
    pub face_of_triangle: Vec<u32>,
    pub map: FacetMap,
    pub centre: Vec3,
    pub material: Material,
    pub camera: Camera,
}

pub struct Material {
    pub base_color: Vec3,
    pub index: f32,
    pub channel_indices: Vec3,
    pub absorption: Vec3,
}

pub struct Camera {
    pub world_from_camera: Mat4,
    pub vertical_fov: f32,
    pub near: f32,
}

/// Reads a file with one stone and one camera.
pub fn read(path: &str) -> Result<Stone, Box<dyn Error>> {
    let gltf = gltf::Gltf::open(path).map_err(|error| format!("is no glTF file: {error}"))?;
    let blob = gltf.blob.as_deref().ok_or("is no .glb with its data inside")?;
    let nodes = nodes(&gltf.document);
    let camera = nodes.iter().find_map(|(node, world)| Some((node.camera()?, *world)));
    let mut meshes = nodes.iter().filter_map(|(node, world)| Some((node.mesh()?, *world)));
    let (Some((mesh, world)), None) = (meshes.next(), meshes.next()) else {
        return Err("holds no mesh, or several: this example draws one stone".into());
    };
    let primitive = mesh.primitives().next().ok_or("its mesh is empty")?;
    let reader = primitive.reader(|buffer| (buffer.index() == 0).then_some(blob));
    let corners = reader.read_positions().ok_or("its mesh has no positions")?;
    let positions: Vec<Vec3> = corners.map(|corner| world.transform_point3(corner.into())).collect();
    let indices: Vec<u32> = reader.read_indices().ok_or("its mesh has no indices")?.into_u32().collect();

    // Facets, not triangles: coplanar triangles are one plane.
    let most = CONVEX_WALK_FACE as usize + 1;
    let facets = Facets::of_mesh(&positions, &indices, most)
        .ok_or_else(|| format!("its mesh {}", Facets::obstacle(&positions, &indices, most)))?;
    // Any point well inside will do for the map's centre. Distances from it keep more digits than
    // those from the world's origin.
    let sum: DVec3 = positions.iter().map(|position| position.as_dvec3()).sum();
    let centre = (sum / positions.len() as f64).as_vec3();
    let planes: Vec<Vec4> = facets
        .planes
        .iter()
        .map(|plane| plane.truncate().extend(plane.w - plane.truncate().dot(centre.as_dvec3())).as_vec4())
        .collect();
    let map = FacetMap::of_stone(&planes)?;
    let (camera, world_from_camera) = camera.ok_or("has no camera")?;
    let Projection::Perspective(lens) = camera.projection() else {
        return Err("its camera is not a perspective one".into());
    };
    Ok(Stone {
        material: material(&primitive.material()),
        camera: Camera { world_from_camera, vertical_fov: lens.yfov(), near: lens.znear() },
        face_of_triangle: facets.face_of_triangle,
        positions,
        indices,
        planes,
        map,
        centre,
    })
}

/// Returns every node of the first scene with its place in the world.
fn nodes(document: &gltf::Document) -> Vec<(gltf::Node<'_>, Mat4)> {
    let mut found = Vec::new();
    let mut open: Vec<(gltf::Node<'_>, Mat4)> = document
        .scenes()
        .next()
        .into_iter()
        .flat_map(|scene| scene.nodes())
        .map(|node| (node, Mat4::IDENTITY))
        .collect();
    while let Some((node, parent)) = open.pop() {
        let (translation, rotation, scale) = node.transform().decomposed();
        let own = Mat4::from_scale_rotation_translation(scale.into(), Quat::from_array(rotation), translation.into());
        open.extend(node.children().map(|child| (child, parent * own)));
        found.push((node, parent * own));
    }
    found
}

/// Reads a clear material by glTF's extensions.
fn material(material: &gltf::Material<'_>) -> Material {
    let number = |extension: &str, name: &str| {
        material.extension_value(extension).and_then(|values| values.get(name)).and_then(Value::as_f64)
    };
    let [red, green, blue, _] = material.pbr_metallic_roughness().base_color_factor();
    let index = number("KHR_materials_ior", "ior").unwrap_or(1.5) as f32;
    let dispersion = number("KHR_materials_dispersion", "dispersion").unwrap_or(0.0) as f32;
    // A mineral's measured curve says more than two numbers. The cookbook's own files name it.
    let extras: Option<Value> = material.extras().as_ref().and_then(|extras| serde_json::from_str(extras.get()).ok());
    let mineral = extras.as_ref().and_then(|extras| extras.get("lapidary")?.get("sellmeier")?.as_str());
    let channel_indices = match mineral {
        Some("diamond") => channels::of_sellmeier(oracle::DISPERSION_DIAMOND),
        Some("corundum") => channels::of_sellmeier(oracle::DISPERSION_CORUNDUM),
        Some("quartz") => channels::of_sellmeier(oracle::DISPERSION_QUARTZ),
        Some("crown_glass") => channels::of_sellmeier(oracle::DISPERSION_CROWN_GLASS),
        Some("cubic_zirconia") => channels::of_sellmeier(oracle::DISPERSION_CUBIC_ZIRCONIA),
        _ => channels::of_abbe(index, dispersion),
    };
    let volume = material.extension_value("KHR_materials_volume");
    let tint = volume.and_then(|values| values.get("attenuationColor")).and_then(Value::as_array);
    let attenuation_color = tint.map_or(Vec3::ONE, |tint| {
        let channel = |place: usize| tint.get(place).and_then(Value::as_f64).unwrap_or(1.0) as f32;
        Vec3::new(channel(0), channel(1), channel(2))
    });
    let attenuation_distance = number("KHR_materials_volume", "attenuationDistance").unwrap_or(f64::INFINITY) as f32;
    Material {
        base_color: Vec3::new(red, green, blue),
        index,
        channel_indices,
        absorption: lapidary_absorption::coefficient(attenuation_color, attenuation_distance),
    }
}
