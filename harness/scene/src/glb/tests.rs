use super::*;
use crate::{BUILT_IN, Density, DensityGrid, Dispersion, Light, Lobe, Medium, Mineral, gltf};
use lapidary_veins::VeinsPattern;

mod textures;

fn chunk(bytes: &[u8], start: usize) -> (&[u8], &[u8]) {
    let length = u32::from_le_bytes(bytes[start..start + 4].try_into().unwrap()) as usize;
    (&bytes[start + 4..start + 8], &bytes[start + 8..start + 8 + length])
}

#[test]
fn every_built_in_scene_survives_writing_and_loading() {
    for built_in in BUILT_IN {
        let scene = Scene::named(built_in.name).unwrap();
        let again = gltf::parse(&write(&scene).unwrap(), None).unwrap();
        assert_eq!(again.name, scene.name);
        for (again, object) in again.objects.iter().zip(&scene.objects) {
            // Copies are written with the thickness of the shape, which their scale then enlarges.
            let thickness = again.material.thickness;
            assert!((thickness - object.material.thickness).abs() <= 1e-6 * thickness);
            let material = Material { thickness, ..object.material.clone() };
            assert!(again.copies == object.copies, "{}", object.name);
            assert_eq!(*again, Object { mesh: object.mesh.without_halo(), material, ..object.clone() });
        }
        assert_eq!(again.objects.len(), scene.objects.len());
        assert_eq!(again.lights, scene.lights);
        assert_eq!(again.environment, scene.environment);
        let (a, b) = (again.camera, scene.camera);
        assert_eq!(a.vertical_fov, b.vertical_fov);
        assert_eq!(a.eye, b.eye);
        let look = |camera: Camera| (camera.target - camera.eye).normalize();
        assert!(look(a).distance(look(b)) < 1e-6 && a.up.distance(b.up) < 1e-6);
    }
}

#[test]
fn the_container_is_aligned_and_complete() {
    let scene = Scene::named("brilliant").unwrap();
    let bytes = write(&scene).unwrap();
    assert_eq!(bytes, write(&scene).unwrap());
    assert_eq!(&bytes[..8], b"glTF\x02\0\0\0");
    let total = u32::from_le_bytes(bytes[8..12].try_into().unwrap());
    assert_eq!(total as usize, bytes.len());
    let (kind, json) = chunk(&bytes, 12);
    assert_eq!((kind, json.len() % 4), (&b"JSON"[..], 0));
    let (kind, binary) = chunk(&bytes, 20 + json.len());
    assert_eq!((kind, binary.len() % 4), (&b"BIN\0"[..], 0));

    let json: Value = serde_json::from_slice(json).unwrap();
    assert_eq!(json["asset"]["generator"], "Lapidary");
    let extensions = &json["materials"][0]["extensions"];
    assert_eq!(extensions["KHR_materials_transmission"]["transmissionFactor"], 1.0);
    assert_eq!(extensions["KHR_materials_ior"]["ior"].as_f64().unwrap() as f32, 2.41749);
    assert_eq!(json["accessors"][0]["max"][0], 1.0);
    let length = json["buffers"][0]["byteLength"].as_u64().unwrap() as usize;
    assert!(binary.len() - length < 4);
}

/// Returns the JSON of a scene as written.
fn json_of(scene: &Scene) -> Value {
    serde_json::from_slice(chunk(&write(scene).unwrap(), 12).1).unwrap()
}

fn medium() -> Medium {
    Medium {
        anisotropy: -0.3,
        density: Density::Veins(VeinsPattern {
            frequency: 0.1,
            width: 0.3,
            least: 0.0,
            greatest: 1.7,
            octaves: 3,
            seed: u32::MAX,
        }),
        ..Medium::isotropic(Vec3::new(0.0, f32::MIN_POSITIVE, 0.1), Vec3::new(1.0 / 7.0, 1e18, 0.0))
    }
}

#[test]
fn every_kind_of_material_survives_writing_and_loading() {
    let mut scene = Scene::named("octahedron").unwrap();
    let standard = Material::standard();
    let measured = Mineral::ALL.map(|mineral| Material {
        ior: mineral.index(),
        dispersion: Dispersion::Sellmeier(mineral),
        ..Material::standard()
    });
    let others = [
        Material { ior: 1.0, base_color: Vec3::ZERO, ..standard.clone() },
        Material { dispersion: Dispersion::Abbe(20.0 / 57.0), ..standard.clone() },
        Material { dispersion: Dispersion::Abbe(f32::MAX), ..standard.clone() },
        Material { attenuation_color: Vec3::new(0.0, 0.1, 1.0), ..standard.clone() },
        Material { attenuation_distance: 1.0 / 3.0, ..standard.clone() },
        Material { attenuation_distance: f32::MIN_POSITIVE, ..standard.clone() },
        Material { attenuation_distance: f32::MAX, attenuation_color: Vec3::splat(0.7), ..standard.clone() },
        Material { roughness: 1.0 / 3.0, ..standard.clone() },
        Material { metallic: 1.0 / 3.0, ..standard.clone() },
        Material { second_lobe: Some(Lobe { roughness: 1.0 / 3.0, weight: 0.1 }), ..standard.clone() },
        Material { sigma0: Some(Vec3::new(0.0, 1.0 / 3.0, f32::MAX)), ..standard.clone() },
        Material { medium: Some(medium()), ..standard.clone() },
        Material { transmission: 1.0, ..standard.clone() },
        Material { transmission: 1.0 / 3.0, thickness: 1.0 / 3.0, ..standard.clone() },
        Material { thickness: f32::MIN_POSITIVE, ..standard.clone() },
        Material { diffuse_transmission: 1.0 / 3.0, ..standard.clone() },
        Material { diffuse_transmission_color: Vec3::new(0.0, 0.1, 1.0), ..standard.clone() },
        Material { sigma0: Some(Vec3::ONE), solver: Some("table-256-rgba8".parse().unwrap()), ..standard.clone() },
        Material { medium: Some(medium()), solver: Some("ping-pong-6-16".parse().unwrap()), ..standard.clone() },
        Material {
            diffuse_transmission: 1.0,
            thickness: 2.0,
            attenuation_distance: 2.0,
            attenuation_color: Vec3::splat(0.7),
            medium: Some(medium()),
            ..standard.clone()
        },
        Material {
            dispersion: Dispersion::Sellmeier(Mineral::Quartz),
            ior: Mineral::Quartz.index(),
            attenuation_distance: 2.0,
            attenuation_color: Vec3::splat(0.7),
            sigma0: Some(Vec3::ZERO),
            medium: Some(medium()),
            ..standard
        },
    ];
    for material in measured.into_iter().chain(others) {
        scene.objects[0].material = material;
        let again = gltf::parse(&write(&scene).unwrap(), None).unwrap();
        assert_eq!(again.objects, scene.objects);
    }
}

#[test]
fn materials_are_written_for_other_readers_too() {
    let mut scene = Scene::named("ruby").unwrap();
    let json = json_of(&scene);
    let used =
        json!(["KHR_materials_dispersion", "KHR_materials_ior", "KHR_materials_transmission", "KHR_materials_volume",]);
    assert_eq!(json["extensionsUsed"], used);
    let material = &json["materials"][0];
    assert_eq!(material["extras"], json!({"lapidary": {"sellmeier": "corundum"}}));
    let extensions = &material["extensions"];
    let dispersion = extensions["KHR_materials_dispersion"]["dispersion"].as_f64().unwrap();
    assert!((20.0 / dispersion - 72.3).abs() < 1e-4);
    let volume = &extensions["KHR_materials_volume"];
    assert_eq!(volume["attenuationDistance"], 2.0);
    assert_eq!(volume["thicknessFactor"], 1.0);

    scene.objects[0].material = Material { transmission: 1.0, thickness: 2.5, ..Material::standard() };
    let json = json_of(&scene);
    let used = json!(["KHR_materials_ior", "KHR_materials_transmission", "KHR_materials_volume"]);
    assert_eq!(json["extensionsUsed"], used);
    assert_eq!(json["materials"][0]["extras"], Value::Null);
    let volume = &json["materials"][0]["extensions"]["KHR_materials_volume"];
    assert_eq!(*volume, json!({"thicknessFactor": 2.5}), "JSON has no infinity");
}

#[test]
fn opaque_bodies_and_thin_walls_are_written_as_such() {
    let mut scene = Scene::named("octahedron").unwrap();
    scene.objects[0].material = Material::standard();
    assert_eq!(json_of(&scene)["extensionsUsed"], json!(["KHR_materials_ior"]));
    scene.objects[0].material = Material { transmission: 0.5, ..Material::standard() };
    let extensions = json_of(&scene)["materials"][0]["extensions"].clone();
    assert_eq!(extensions["KHR_materials_transmission"], json!({"transmissionFactor": 0.5}));
    assert_eq!(extensions["KHR_materials_volume"], Value::Null);
}

#[test]
fn what_scatters_is_written_as_opaque_with_its_numbers_beside() {
    let mut scene = Scene::named("jade_ring").unwrap();
    let json = json_of(&scene);
    assert_eq!(json["extensionsUsed"], json!(["KHR_lights_punctual", "KHR_materials_ior"]));
    let material = &json["materials"][0];
    let members = material["extras"]["lapidary"].as_object().unwrap();
    assert_eq!(members.keys().collect::<Vec<_>>(), ["absorption", "scattering", "sigma0"]);
    assert_eq!(members["scattering"][1].as_f64().unwrap() as f32, 1.2);
    assert_eq!(material["pbrMetallicRoughness"]["roughnessFactor"], 0.0);

    scene.objects[0].material.attenuation_distance = 3.0;
    let used = json!(["KHR_lights_punctual", "KHR_materials_ior", "KHR_materials_volume"]);
    assert_eq!(json_of(&scene)["extensionsUsed"], used);
}

#[test]
fn texture_coordinates_are_written_where_there_are_some() {
    let mut scene = Scene::named("octahedron").unwrap();
    let attributes = |scene: &Scene| json_of(scene)["meshes"][0]["primitives"][0]["attributes"].clone();
    assert_eq!(attributes(&scene)["TEXCOORD_0"], Value::Null);
    let uv = |k: usize| Vec2::new(k as f32 / 7.0, -1e30);
    scene.objects[0].mesh.uvs = (0..scene.objects[0].mesh.positions.len()).map(uv).collect();
    assert!(attributes(&scene)["TEXCOORD_0"].is_u64());
    assert_eq!(gltf::parse(&write(&scene).unwrap(), None).unwrap().objects, scene.objects);
}

#[test]
fn every_kind_of_light_survives_writing_and_loading() {
    let mut scene = Scene::named("octahedron").unwrap();
    let toward = |x, y, z| Vec3::new(x, y, z).normalize();
    let directions = [Vec3::X, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z, toward(-0.7, 0.6, 0.2), toward(1e-9, -1.0, 1e-3)];
    let lights = [Vec3::ZERO, Vec3::new(0.1, 1.0 / 3.0, 7e5), Vec3::new(f32::MAX, f32::MIN_POSITIVE, 1e-40)];
    for radiometric in lights {
        scene.lights.extend(directions.map(|toward| Light::Directional { toward, irradiance: radiometric }));
        scene.lights.extend(directions.map(|place| Light::Point { position: 1e5 * place, intensity: radiometric }));
        let cones = [(0.0, 1e-7), (0.0, std::f32::consts::FRAC_PI_2), (0.1, 0.3)];
        for (inner_angle, outer_angle) in cones {
            scene.lights.extend(directions.map(|direction| Light::Spot {
                position: 1e5 * Vec3::new(0.1, 0.7, -0.3),
                direction,
                intensity: radiometric,
                inner_angle,
                outer_angle,
            }));
        }
    }
    let again = gltf::parse(&write(&scene).unwrap(), None).unwrap();
    assert_eq!(again.lights, scene.lights);
    assert_eq!(again.objects, scene.objects);

    // Other readers expect colours from 0 to 1, and derive a rotation from the matrix.
    let json = json_of(&scene);
    for light in json["extensions"]["KHR_lights_punctual"]["lights"].as_array().unwrap() {
        let color = light["color"].as_array().unwrap().iter().map(|part| part.as_f64().unwrap());
        assert_eq!(color.fold(0.0, f64::max), 1.0, "{light}");
    }
    for node in json["nodes"].as_array().unwrap().iter().filter(|node| node["matrix"].is_array()) {
        let matrix: Vec<f32> = node["matrix"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap() as f32).collect();
        let turn = glam::Mat3::from_mat4(glam::Mat4::from_cols_slice(&matrix));
        assert!((turn * turn.transpose()).abs_diff_eq(glam::Mat3::IDENTITY, 1e-6), "{node}");
        assert!((turn.determinant() - 1.0).abs() < 1e-6, "{node}");
    }
}

#[test]
fn what_gltf_forbids_is_refused() {
    let good = Scene::named("octahedron").unwrap();
    let refused = |change: fn(&mut Scene)| {
        let mut scene = good.clone();
        change(&mut scene);
        write(&scene).unwrap_err().to_string()
    };
    assert!(refused(|s| s.objects.clear()).contains("no objects"));
    assert!(refused(|s| s.camera.vertical_fov = f32::NAN).contains("camera"));
    assert!(refused(|s| s.camera.eye.x = f32::INFINITY).contains("camera"));
    assert!(refused(|s| s.objects[0].mesh.indices.clear()).contains("no triangles"));
    assert!(refused(|s| s.objects[0].mesh.indices.truncate(4)).contains("multiple of three"));
    assert!(refused(|s| s.objects[0].mesh.indices[0] = 99).contains("past its last"));
    assert!(refused(|s| s.objects[0].mesh.normals.truncate(1)).contains("one normal"));
    assert!(refused(|s| s.objects[0].material.attenuation_distance = 0.0).contains("attenuation distance"));
    assert!(refused(|s| s.objects[0].material.ior = 2.4).contains("Sellmeier"));
    assert!(refused(|s| s.objects[0].mesh.positions[0].x = f32::NAN).contains("not finite"));
    assert!(refused(|s| s.objects[0].material.ior = f32::NAN).contains("refractive index"));
    assert!(refused(|s| s.objects[0].material.roughness = 1.1).contains("roughness"));
    assert!(refused(|s| s.objects[0].material.metallic = f32::NAN).contains("metallic"));
    const FLAT: Option<Lobe> = Some(Lobe { roughness: 0.0, weight: 0.5 });
    assert!(refused(|s| s.objects[0].material.second_lobe = FLAT).contains("second lobe"));
    assert!(refused(|s| s.objects[0].material.sigma0 = Some(Vec3::NEG_X)).contains("sigma0"));
    assert!(refused(|s| s.objects[0].material.thickness = -1.0).contains("thickness"));
    assert!(refused(|s| s.objects[0].material.transmission = f32::NAN).contains("transmission"));
    assert!(refused(|s| s.objects[0].material.solver = "accurate".parse().ok()).contains("does not scatter light"));
    let broken = Medium { absorption: Vec3::NAN, ..medium() };
    let mut scene = good.clone();
    scene.objects[0].material.medium = Some(broken);
    assert!(write(&scene).unwrap_err().to_string().contains("absorption"));
    let grid = DensityGrid::new(Vec3::ZERO, Vec3::ONE, glam::UVec3::ONE, vec![1.0]).expect("sound");
    let density = Density::Grid(std::sync::Arc::new(grid));
    scene.objects[0].material.medium = Some(Medium { density, ..medium() });
    assert!(write(&scene).unwrap_err().to_string().contains("grid"));
    assert!(refused(|s| s.objects[0].mesh.uvs = vec![Vec2::ZERO]).contains("texture coordinates"));
    let uvs = |s: &mut Scene| s.objects[0].mesh.uvs = vec![Vec2::INFINITY; s.objects[0].mesh.positions.len()];
    assert!(refused(uvs).contains("texture coordinate is not finite"));
    let sound = Light::Point { position: Vec3::ZERO, intensity: Vec3::ONE };
    let spot = |direction, position, intensity, inner_angle, outer_angle| Light::Spot {
        position,
        direction,
        intensity,
        inner_angle,
        outer_angle,
    };
    for (light, says) in [
        (spot(2.0 * Vec3::X, Vec3::ZERO, Vec3::ONE, 0.1, 0.2), "unit length"),
        (spot(Vec3::X, Vec3::NAN, Vec3::ONE, 0.1, 0.2), "position"),
        (spot(Vec3::X, Vec3::ZERO, Vec3::NEG_X, 0.1, 0.2), "not finite and at least 0"),
        (spot(Vec3::X, Vec3::ZERO, Vec3::ONE, 0.2, 0.2), "angles"),
        (spot(Vec3::X, Vec3::ZERO, Vec3::ONE, -0.1, 0.2), "angles"),
        (spot(Vec3::X, Vec3::ZERO, Vec3::ONE, 0.1, 1.6), "angles"),
        (spot(Vec3::X, Vec3::ZERO, Vec3::ONE, f32::NAN, 0.2), "angles"),
        (spot(Vec3::X, Vec3::ZERO, Vec3::ONE, 0.1, f32::NAN), "angles"),
        (Light::Directional { toward: 2.0 * Vec3::X, irradiance: Vec3::ONE }, "unit length"),
        (Light::Directional { toward: Vec3::X, irradiance: Vec3::NAN }, "not finite and at least 0"),
        (Light::Point { position: Vec3::INFINITY, intensity: Vec3::ONE }, "position"),
        (Light::Point { position: Vec3::ZERO, intensity: Vec3::NEG_Z }, "not finite and at least 0"),
    ] {
        let scene = Scene { lights: vec![sound, light], ..good.clone() };
        let message = write(&scene).unwrap_err().to_string();
        assert!(message.starts_with("light 1 cannot be written") && message.contains(says), "{message}");
    }
}
