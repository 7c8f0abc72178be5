//! The properties that `extras.lapidary` gives a material.

use serde::Deserialize;
use serde_json::value::RawValue;

use super::{Lapidary, is_object, lengths};
use crate::gltf::error::excerpt;
use crate::gltf::medium::medium;
use crate::normals::Normals;
use crate::{Dispersion, Lobe, Material, Mineral, Solver};

/// Maximum distance of a file's index from that of its Sellmeier equation: tables give two
/// decimals.
const INDEX_AGREES: f64 = 0.005;
/// Maximum relative difference between a file's dispersion and that of its Sellmeier equation:
/// measured Abbe numbers of one mineral differ by a few percent.
const DISPERSION_AGREES: f64 = 0.05;

impl Lapidary<'_> {
    /// Applies the extras to `material`, whose extensions state `ior` and `dispersion`.
    pub(in crate::gltf) fn apply(
        &self,
        material: &mut Material,
        ior: Option<f64>,
        dispersion: Option<f64>,
    ) -> Result<(), String> {
        if let Some(mineral) = self.sellmeier.map(mineral).transpose()? {
            agree(mineral, ior, dispersion)?;
            material.ior = mineral.index();
            material.dispersion = Dispersion::Sellmeier(mineral);
        }
        material.sigma0 = self.sigma0.map(|json| lengths("sigma0", json)).transpose()?;
        material.medium = medium(self)?;
        material.second_lobe = self.second_lobe.map(lobe).transpose()?;
        material.priority = self.priority.map_or(Ok(0), priority)?;
        material.normals = self.normals.map_or(Ok(Normals::Decided), normals)?;
        material.solver = self.solver.map(solver).transpose()?;
        if material.solver.is_some() && !material.scatters() {
            return Err("its extras.lapidary has a solver, but nothing there scatters light; give scattering and absorption, or \
                        sigma0, or remove the solver"
                .to_owned());
        }
        if matches!(material.solver, Some(Solver::OpticalPath(_) | Solver::Diffusion(_))) && material.medium.is_none() {
            return Err("its extras.lapidary has a solver that follows light through the body, but no scattering and absorption to follow light by; give \
                        them, or another solver"
                .to_owned());
        }
        Ok(())
    }
}

/// Checks that the file's own values, if present, agree with those of the mineral.
fn agree(mineral: Mineral, ior: Option<f64>, dispersion: Option<f64>) -> Result<(), String> {
    let (name, index) = (mineral.name(), mineral.index());
    if let Some(ior) = ior.filter(|ior| (ior - f64::from(index)).abs() > INDEX_AGREES) {
        return Err(format!(
            "its ior is {ior}, but the Sellmeier equation of {name} in its extras gives {index}; leave one of them out"
        ));
    }
    let measured = 20.0 / f64::from(mineral.abbe_number());
    if let Some(dispersion) = dispersion.filter(|given| (given / measured - 1.0).abs() > DISPERSION_AGREES) {
        return Err(format!(
            "its dispersion is {dispersion:?}, but the Sellmeier equation of {name} in its extras gives {measured:.3}; leave one of \
             them out"
        ));
    }
    Ok(())
}

fn priority(json: &RawValue) -> Result<i32, String> {
    serde_json::from_str(json.get()).map_err(|_| {
        format!("its extras.lapidary.priority is {}, but must be a whole number of 32 bits", excerpt(json.get()))
    })
}

/// Normals named by `normals`.
fn normals(json: &RawValue) -> Result<Normals, String> {
    let normals = serde_json::from_str::<String>(json.get()).ok().and_then(|name| Normals::named(&name));
    normals.ok_or_else(|| {
        format!("its extras.lapidary.normals is {}, but must be \"file\" or \"facets\"", excerpt(json.get()))
    })
}

/// Mineral named by `sellmeier`.
fn mineral(json: &RawValue) -> Result<Mineral, String> {
    let mineral = serde_json::from_str::<String>(json.get()).ok().and_then(|name| Mineral::named(&name));
    mineral.ok_or_else(|| {
        format!(
            "its extras.lapidary.sellmeier is {}, but must be one of {}",
            excerpt(json.get()),
            Mineral::ALL.map(|mineral| format!("{:?}", mineral.name())).join(", ")
        )
    })
}

/// The members of `secondLobe`; both are required, so that a misspelt name is an error.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LobeMembers {
    roughness: f32,
    weight: f32,
}

/// Lobe given by `secondLobe`.
fn lobe(json: &RawValue) -> Result<Lobe, String> {
    let read = is_object(json).then(|| serde_json::from_str::<LobeMembers>(json.get()).ok()).flatten();
    let lobe = read.map(|LobeMembers { roughness, weight }| Lobe { roughness, weight });
    lobe.filter(|lobe| lobe.is_sound()).ok_or_else(|| {
        format!(
            "its extras.lapidary.secondLobe is {}, but must be an object with a roughness above 0 and at most 1, and a weight \
             above 0 and below 1",
            excerpt(json.get())
        )
    })
}

/// Solver named by `solver`.
fn solver(json: &RawValue) -> Result<Solver, String> {
    let solver = serde_json::from_str::<String>(json.get()).ok().and_then(|name| name.parse().ok());
    solver.ok_or_else(|| {
        format!(
            "its extras.lapidary.solver is {}, but must be a rung for what scatters light, such as lambert, accurate, blur or \
             godunov-64; `./cook render --help` says which there are",
            excerpt(json.get())
        )
    })
}
