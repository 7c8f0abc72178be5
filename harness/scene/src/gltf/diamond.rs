//! `WEBGI_materials_diamond`: a vendor's mark of a clear stone, with its index, dispersion and colour. What it says of that
//! vendor's own picture, such as `rayBounces`, is passed over.

use glam::Vec3;
use lapidary_srgb::decode;
use serde_json::{Map, Value};

use super::error::excerpt;
use super::extension::Extension;
use crate::shells::Shells;
use crate::{Bounds, Dispersion, Material, Mesh};

/// Name of the extension.
pub(super) const NAME: &str = "WEBGI_materials_diamond";
/// Index without a `refractiveIndex`: that of diamond.
const INDEX: f64 = 2.417;

/// The stone that a material is marked as.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Diamond {
    /// Refractive index as given.
    pub(super) index: f64,
    /// By how much the index of red is less, and that of blue more, than that of green.
    spread: f64,
    /// Colour after half of the stone's extent, linear RGB, for a factor of 1.
    color: Vec3,
    /// Factor of the absorption.
    absorption: f64,
}

impl Diamond {
    /// Reads the extension; `None` if a material does not have it.
    pub(super) fn of(all: Option<&Map<String, Value>>) -> Result<Option<Self>, String> {
        if !all.is_some_and(|all| all.contains_key(NAME)) {
            return Ok(None);
        }
        let members = Extension::of(all, NAME)?;
        let number = |key: &str, usual: f64| {
            let number = members.number(key)?.unwrap_or(usual);
            let is_proper = (0.0..=f64::from(f32::MAX)).contains(&number);
            is_proper.then_some(number).ok_or_else(|| {
                format!("its {key} of {NAME} is {number:?}, but must be at least 0 and finite in single precision")
            })
        };
        Ok(Some(Self {
            index: number("refractiveIndex", INDEX)?,
            spread: number("dispersion", 0.0)?,
            color: members.member("color").map_or(Ok(Vec3::ONE), color)?,
            absorption: number("absorptionFactor", 1.0)?,
        }))
    }

    /// Makes a material the stone: clear, polished, with an inside. Its other colours, its alpha and its images stand for a
    /// stone in other programs.
    pub(super) fn apply(self, material: &mut Material) {
        let index = (self.index as f32).clamp(1.0, Material::LARGEST_INDEX);
        // V = (n - 1) / (n_F - n_C), as glTF writes it.
        let dispersion = (20.0 * 2.0 * self.spread / f64::from(index - 1.0)) as f32;
        let is_sound = dispersion > 0.0 && dispersion.is_finite();
        *material = Material {
            ior: index,
            dispersion: if is_sound { Dispersion::Abbe(dispersion) } else { Dispersion::None },
            attenuation_color: self.color,
            transmission: 1.0,
            thickness: if material.thickness > 0.0 { material.thickness } else { 1.0 },
            roughness: 0.0,
            double_sided: material.double_sided,
            normals: material.normals,
            priority: material.priority,
            ..Material::standard()
        };
    }

    /// Gives a material the distance after which a stone of this mesh has its colour: half of its extent, over the factor. Of
    /// several stones in one mesh the largest counts.
    pub(super) fn absorb(self, material: &mut Material, mesh: &Mesh) {
        if self.color == Vec3::ONE || self.absorption == 0.0 {
            return;
        }
        let extent = |mesh: &Mesh| {
            let Bounds { min, max } = Bounds::of(mesh.positions.iter().copied());
            (max - min).max_element()
        };
        let largest = Shells::of(mesh).and_then(|shells| shells.solids.iter().map(extent).reduce(f32::max));
        let distance = 0.5 * f64::from(largest.unwrap_or_else(|| extent(mesh))) / self.absorption;
        material.attenuation_distance = (distance as f32).clamp(f32::MIN_POSITIVE, f32::MAX);
    }
}

/// Reads a colour: three linear numbers, an object of them, or sRGB as a number or as `#rrggbb`.
fn color(value: &Value) -> Result<Vec3, String> {
    let of_members = || Some([value.get("r")?.as_f64()?, value.get("g")?.as_f64()?, value.get("b")?.as_f64()?]);
    let of_list = || {
        let list = value.as_array().filter(|list| list.len() >= 3)?;
        Some([list[0].as_f64()?, list[1].as_f64()?, list[2].as_f64()?])
    };
    let of_text = || {
        let digits = value.as_str()?.strip_prefix(['#'])?;
        u64::from_str_radix(digits, 16).ok().filter(|_| digits.len() == 6)
    };
    let linear = of_list().or_else(of_members).map(|parts| Vec3::from_array(parts.map(|part| part as f32)));
    let coded = value.as_u64().or_else(of_text).filter(|number| *number <= 0xff_ffff).map(|number| {
        let part = |shift: u32| decode((number >> shift & 0xff) as f32 / 255.0);
        Vec3::new(part(16), part(8), part(0))
    });
    let is_color = |color: &Vec3| color.to_array().iter().all(|part| (0.0..=1.0).contains(part));
    linear.or(coded).filter(is_color).ok_or_else(|| {
        let found = excerpt(&value.to_string());
        format!("its color of {NAME} is {found}, but must be three numbers from 0 to 1, or sRGB such as 16777215 or \"#ffffff\"")
    })
}
