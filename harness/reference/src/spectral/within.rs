//! Bodies that lie within one another: which of those around a point is its matter.
//!
//! Where bodies share space, the one of the highest priority is there, and the surfaces of the others are not met (Schmidt and
//! Budge, "Simple Nested Dielectrics in Ray Traced Images", Journal of Graphics Tools 7(2), 2002). Of equal priority is the
//! body of the smaller volume, so that a body that lies wholly inside another one is seen there.

use glam::Vec3;
use lapidary_scene::{Object, precedence};

/// Largest number of bodies around a point; a ray that enters a further one is lost.
pub(crate) const MOST: usize = 12;

/// For each body its place in the order of priorities, the highest last.
#[derive(Debug)]
pub(super) struct Order(Vec<u32>);

impl Order {
    pub(super) fn of(objects: &[Object]) -> Self {
        Self(precedence(objects))
    }
}

/// The clear bodies around a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Within {
    // A scene has at most 2^16 bodies.
    bodies: [u16; MOST],
    count: u8,
    /// Whether light was coloured as it came into each, a bit for each.
    colored: u16,
}

const _: () = assert!(lapidary_scene::gltf::MAX_OBJECTS <= 1 << u16::BITS && MOST <= u16::BITS as usize);

impl Within {
    /// The clear bodies around a point; those beyond the largest number are left out.
    pub(super) fn around(point: Vec3, objects: &[Object]) -> Self {
        let has_inside = |object: &Object| !object.material.is_opaque() && !object.material.is_thin_wall();
        let is_around = |object: &Object| has_inside(object) && object.mesh.encloses(point);
        let bodies = objects.iter().enumerate().filter(|(_, object)| is_around(object));
        bodies.fold(Self::default(), |within, (body, _)| within.with(body).unwrap_or(within))
    }

    pub(super) fn bodies(&self) -> impl Iterator<Item = usize> {
        self.bodies[..usize::from(self.count)].iter().map(|body| usize::from(*body))
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    pub(super) fn holds(&self, body: usize) -> bool {
        self.bodies().any(|held| held == body)
    }

    /// The body whose matter is there; `None` in the air.
    pub(super) fn matter(&self, Order(places): &Order) -> Option<usize> {
        self.bodies().max_by_key(|body| places[*body])
    }

    /// These bodies and another one; `None` if they are too many.
    pub(super) fn with(mut self, body: usize) -> Option<Self> {
        *self.bodies.get_mut(usize::from(self.count))? = body as u16;
        self.count += 1;
        Some(self)
    }

    /// These bodies without one of them.
    pub(super) fn without(self, body: usize) -> Self {
        let mut rest = Self::default();
        for (place, held) in self.bodies().enumerate().filter(|(_, held)| *held != body) {
            rest.bodies[usize::from(rest.count)] = held as u16;
            rest.colored |= (self.colored >> place & 1) << rest.count;
            rest.count += 1;
        }
        rest
    }

    /// Notes that light was coloured as it came into `body`. Returns whether it was not before.
    pub(super) fn color(&mut self, body: usize) -> bool {
        let Some(place) = self.bodies().position(|held| held == body) else { return false };
        let was = self.colored;
        self.colored |= 1 << place;
        was != self.colored
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_come_and_go_with_their_colors() {
        let mut within = Within::default();
        assert!(within.is_empty() && within.matter(&Order(vec![0; 9])).is_none());
        for body in [5, 2, 7] {
            within = within.with(body).expect("room");
        }
        assert!(within.color(2) && !within.color(2) && !within.color(9));
        let mut rest = within.without(5);
        assert_eq!(rest.bodies().collect::<Vec<_>>(), [2, 7]);
        assert!(!rest.color(2) && rest.color(7) && rest.holds(7) && !rest.holds(5));
        assert_eq!(within.without(9), within);
        assert_eq!(within.matter(&Order((0..9).collect())), Some(7));
        let full = (0..MOST).try_fold(Within::default(), |within, body| within.with(body)).expect("room");
        assert!(full.with(MOST).is_none());
    }
}
