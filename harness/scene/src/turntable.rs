//! A scene on a turntable: its bodies turn about the vertical through their middle, before the camera and under the lights.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use crate::object::vertices;
use crate::view::View;
use crate::{Camera, Copies, Mesh, Object, Place, Scene};

impl Scene {
    /// Returns the bodies at `count` angles, evenly spread over a whole turn from that of the scene, seen by one camera: the scene's
    /// where it shows all of each picture of `size` pixels, or else one that stands in the same direction and does.
    #[must_use]
    pub fn turntable(self, count: u32, [width, height]: [u32; 2]) -> impl ExactSizeIterator<Item = Self> {
        let middle = self.bounds().centre().as_dvec3();
        let turn = move |step: u32| DQuat::from_rotation_y(TAU * f64::from(step) / f64::from(count));
        let camera = {
            let view = View::new(&self.camera, width, height);
            let around = (0..count).flat_map(|step| {
                vertices(&self.objects).map(move |point| turned(point.as_dvec3(), turn(step), middle).as_vec3())
            });
            if around.clone().all(|point| view.sight(point.as_dvec3()).is_some()) {
                self.camera
            } else {
                Camera::framing(around, self.camera.eye - self.camera.target, self.camera.vertical_fov)
            }
        };
        (0..count).map(move |step| {
            let objects = self.objects.iter().map(|object| body(object, turn(step), middle)).collect();
            Self { objects, camera, ..self.clone() }
        })
    }
}

fn turned(point: DVec3, turn: DQuat, middle: DVec3) -> DVec3 {
    turn * (point - middle) + middle
}

fn body(object: &Object, turn: DQuat, middle: DVec3) -> Object {
    let placed = |mesh: &Mesh| mesh.placed(turn, middle - turn * middle);
    let place = |place: &Place| Place {
        rotation: (turn * place.rotation.as_dquat()).as_quat(),
        translation: turned(place.translation.as_dvec3(), turn, middle).as_vec3(),
        ..*place
    };
    match &object.copies {
        None => Object { mesh: placed(&object.mesh), ..object.clone() },
        Some(Copies { shape, places }) => {
            let copies = Copies { shape: shape.clone(), places: places.iter().map(place).collect() };
            Object::of_copies(object.name.clone(), copies, object.material.clone())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_turn_under_a_camera_that_shows_them_all() {
        for name in ["brilliant", "solitaire", "chandelier"] {
            let scene = Scene::named(name).unwrap();
            let all: Vec<Scene> = scene.clone().turntable(8, [64, 64]).collect();
            assert_eq!(all.len(), 8);
            let off = |scene: &Scene, other: &Scene| {
                let points = vertices(&scene.objects).zip(vertices(&other.objects));
                points.map(|(one, other)| one.distance(other)).fold(0.0, f32::max)
            };
            let radius = scene.bounds().radius();
            assert!(off(&scene, &all[0]) <= 1e-6 * radius, "{name}");
            assert!(off(&scene, &all[4]) > 0.5 * radius, "{name}");
            let half: Vec<Scene> = all[4].clone().turntable(2, [64, 64]).collect();
            assert!(off(&scene, &half[1]) <= 4e-6 * radius, "{name}");
            for turned in &all {
                assert_eq!((turned.camera, &turned.lights), (all[0].camera, &scene.lights));
                let view = View::new(&turned.camera, 64, 64);
                assert!(vertices(&turned.objects).all(|point| view.sight(point.as_dvec3()).is_some()), "{name}");
            }
        }
    }

    #[test]
    fn copies_stay_one_shape() {
        let scene = Scene::named("chandelier").unwrap();
        let of_copies = |scene: &Scene| scene.objects.iter().filter(|object| object.copies.is_some()).count();
        let turned = scene.clone().turntable(3, [64, 64]).last().unwrap();
        assert_eq!(of_copies(&turned), of_copies(&scene));
        let up = |object: &Object| object.mesh.normals.iter().map(|normal| normal.y).sum::<f32>();
        for (one, other) in scene.objects.iter().zip(&turned.objects) {
            assert_eq!(one.shape(), if one.copies.is_some() { other.shape() } else { one.shape() });
            assert!((up(one) - up(other)).abs() < 1e-2 + 1e-5 * one.mesh.normals.len() as f32);
        }
    }
}
