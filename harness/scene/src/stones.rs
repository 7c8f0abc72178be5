//! The clear stones of a scene as bodies of their own: mended, parted where a mesh holds several, and as copies where several
//! are one shape.

use std::collections::HashMap;

use crate::copies::MOST_JOINED;
use crate::gltf::MAX_OBJECTS;
use crate::registration::{self, Group};
use crate::shells::Shells;
use crate::{Copies, Mesh, Object, Scene};

mod alike;
mod note;
mod recovery;

use alike::Kinds;
pub use note::StoneNote;

/// Largest number of bodies that one mesh becomes, copies of a shape counted once: of more, those that have no copies stay
/// together, as they were.
const MOST_BODIES: usize = 256;

/// What became of the clear bodies of a scene.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Parting {
    /// For each body that there is now, the number of the one that it comes from; of copies that come from several, the first.
    pub origins: Vec<usize>,
    /// What was done, one note for each kind of change.
    pub notes: Vec<StoneNote>,
}

/// A clear body as it is parted.
struct Parted {
    origin: usize,
    /// The kind of its material, and whether its shape says all about how it looks.
    kind: usize,
    shells: Shells,
    /// Distance by which a corner may be off.
    noise: f64,
    /// Whether it holds what was another body's.
    is_joined: bool,
}

/// A solid, by the number of its parted body and its own there.
type Which = (usize, usize);

impl Scene {
    /// Mends the clear bodies that have an inside, parts those of several closed shells, and joins those of one shape and
    /// material to copies. A body stays as it is if it has copies already, or if its mesh is too large or without area; one at
    /// which there was nothing to mend, part or join keeps its very mesh. Those that are `apart` are joined to no body of another
    /// name.
    ///
    /// Where a body becomes several, they are named `NAME stones 1`, or `NAME stone 1` if it has no copies, and so on, in the
    /// order of their first triangles; what is not closed keeps the name.
    pub fn part_stones(&mut self, apart: impl Fn(&Object) -> bool) -> Parting {
        let mut notes = Vec::new();
        let mut kinds = Kinds::default();
        let mut parted: Vec<Parted> = Vec::new();
        for (origin, object) in self.objects.iter().enumerate() {
            let is_stone = object.material.has_clear_inside() && object.copies.is_none();
            // Nothing would be left of one without an area, not even its name.
            if !is_stone || !object.mesh.has_area() {
                continue;
            }
            match Shells::of(&object.mesh) {
                Some(shells) => {
                    let noise = registration::noise(&object.mesh).max(shells.tolerance);
                    parted.push(Parted {
                        origin,
                        kind: kinds.of(object, apart(object)),
                        shells,
                        noise,
                        is_joined: false,
                    });
                }
                None => note::add(&mut notes, StoneNote::TooLarge { first: object.name.clone(), objects: 1 }),
            }
        }
        self.join_open(&mut parted, &mut notes);
        for Parted { origin, shells, .. } in &mut parted {
            shells.close();
            let first = self.objects[*origin].name.clone();
            note::add(&mut notes, StoneNote::Mended { first, objects: 1, mends: shells.mends });
        }
        let groups = groups(&self.objects, &parted);
        self.rebuild(parted, groups, notes)
    }

    /// Joins the open parts of bodies that are primitives of one mesh, of materials equal in all but name, where they close one
    /// another.
    fn join_open(&self, parted: &mut [Parted], notes: &mut Vec<StoneNote>) {
        let mut of_mesh: HashMap<(usize, &str), Vec<usize>> = HashMap::new();
        for (number, part) in parted.iter().enumerate().filter(|(_, part)| !part.shells.open.is_empty()) {
            // The loader's name for one of several primitives.
            if let Some((mesh, _)) = self.objects[part.origin].name.rsplit_once(" / ") {
                of_mesh.entry((part.kind, mesh)).or_default().push(number);
            }
        }
        let mut sets: Vec<Vec<usize>> = of_mesh.into_values().filter(|set| set.len() > 1).collect();
        sets.sort_unstable();
        for set in sets {
            let mut all = Mesh::default();
            set.iter().flat_map(|&number| &parted[number].shells.open).for_each(|open| all.append(open));
            let Some(shells) = Shells::of(&all).filter(|shells| shells.open.is_empty()) else { continue };
            set.iter().for_each(|&number| parted[number].shells.open.clear());
            let first = &mut parted[set[0]];
            first.shells.solids.extend(shells.solids);
            first.shells.mends += shells.mends;
            first.is_joined = true;
            let name = self.objects[first.origin].name.clone();
            note::add(notes, StoneNote::Closed { first: name, objects: set.len() });
        }
    }

    /// Puts the solids, groups and open parts in place of the bodies that they come from.
    fn rebuild(&mut self, parted: Vec<Parted>, groups: Vec<(Group, Vec<Which>)>, mut notes: Vec<StoneNote>) -> Parting {
        let mut group_of: HashMap<Which, usize> = HashMap::new();
        for (number, (_, members)) in groups.iter().enumerate() {
            group_of.extend(members.iter().map(|member| (*member, number)));
            let mut bodies: Vec<usize> = members.iter().map(|(body, _)| *body).collect();
            bodies.dedup();
            if bodies.len() > 1 {
                let first = self.objects[parted[bodies[0]].origin].name.clone();
                note::add(&mut notes, StoneNote::Joined { first, bodies: bodies.len(), copies: members.len() });
            }
        }
        let mut groups: Vec<Option<Copies>> = groups.into_iter().map(|(group, _)| Some(group.copies)).collect();
        let mut built = Built::default();
        let mut parted = parted.into_iter().enumerate().peekable();
        for (origin, object) in std::mem::take(&mut self.objects).into_iter().enumerate() {
            let Some((body, part)) = parted.next_if(|(_, part)| part.origin == origin) else {
                built.push(object, origin);
                continue;
            };
            let solids = part.shells.solids.len();
            let has_copies = (0..solids).any(|solid| group_of.contains_key(&(body, solid)));
            if part.shells.is_as_given() && !part.is_joined && !has_copies {
                built.push(object, origin);
                continue;
            }
            let mut stones = Vec::new();
            let mut rest = Mesh::default();
            let ungrouped = (0..solids).filter(|&solid| !group_of.contains_key(&(body, solid))).count();
            let are_apart = ungrouped <= MOST_BODIES && built.objects.len() + ungrouped < MAX_OBJECTS as usize;
            for (solid, mesh) in part.shells.solids.into_iter().enumerate() {
                match group_of.get(&(body, solid)) {
                    Some(&group) => stones.extend(groups[group].take().into_iter().flat_map(chunks).map(Stone::Copies)),
                    None if are_apart => stones.push(Stone::Single(mesh)),
                    None => rest.append(&mesh),
                }
            }
            part.shells.open.iter().for_each(|open| rest.append(open));
            let has_rest = !rest.indices.is_empty();
            if solids + usize::from(has_rest) > 1 {
                let first = object.name.clone();
                let bodies = stones.len() + usize::from(has_rest);
                note::add(&mut notes, StoneNote::Parted { first, objects: 1, solids, bodies, rest: has_rest });
            }
            built.stones(&object, origin, stones, rest);
        }
        self.objects = built.objects;
        Parting { origins: built.origins, notes }
    }
}

/// A body that comes from another one.
enum Stone {
    Copies(Copies),
    Single(Mesh),
}

/// The bodies of the new scene.
#[derive(Default)]
struct Built {
    objects: Vec<Object>,
    origins: Vec<usize>,
}

impl Built {
    fn push(&mut self, object: Object, origin: usize) {
        self.objects.push(object);
        self.origins.push(origin);
    }

    /// Adds what an object became.
    fn stones(&mut self, object: &Object, origin: usize, stones: Vec<Stone>, rest: Mesh) {
        let is_one = stones.len() + usize::from(!rest.indices.is_empty()) == 1;
        for (number, stone) in (1..).zip(stones) {
            let name =
                |kind: &str| if is_one { object.name.clone() } else { format!("{} {kind} {number}", object.name) };
            let material = object.material.clone();
            self.push(
                match stone {
                    Stone::Copies(copies) => Object::of_copies(name("stones"), copies, material),
                    Stone::Single(mesh) => Object::new(name("stone"), mesh, material),
                },
                origin,
            );
        }
        if !rest.indices.is_empty() {
            self.push(Object::new(object.name.clone(), rest, object.material.clone()), origin);
        }
    }
}

/// Returns copies as bodies none of which is too large for a device.
fn chunks(copies: Copies) -> Vec<Copies> {
    let Copies { shape, places } = copies;
    let size = shape.positions.len().max(shape.indices.len()).max(1);
    let most = (MOST_JOINED / size).max(1);
    places.chunks(most).map(|places| Copies { shape: shape.clone(), places: places.to_vec() }).collect()
}

/// Returns the solids that are one shape and of one material, each group with the solids that it stands for.
fn groups(objects: &[Object], parted: &[Parted]) -> Vec<(Group, Vec<Which>)> {
    let mut of_kind: HashMap<usize, Vec<Which>> = HashMap::new();
    for (body, part) in parted.iter().enumerate() {
        if alike::is_told_by_shape(&objects[part.origin]) {
            of_kind.entry(part.kind).or_default().extend((0..part.shells.solids.len()).map(|solid| (body, solid)));
        }
    }
    let mut found = Vec::new();
    for which in of_kind.into_values() {
        let meshes: Vec<&Mesh> = which.iter().map(|&(body, solid)| &parted[body].shells.solids[solid]).collect();
        let noise: Vec<f64> = which.iter().map(|&(body, _)| parted[body].noise).collect();
        let is_smooth = |(mesh, &(body, _)): (&&Mesh, &Which)| objects[parted[body].origin].material.is_smooth(mesh);
        let smooth: Vec<bool> = meshes.iter().zip(&which).map(is_smooth).collect();
        for group in registration::groups(&meshes, &noise, &smooth) {
            let members = group.members.iter().map(|&member| which[member]).collect();
            found.push((group, members));
        }
    }
    found.sort_by(|(_, one), (_, other): &(Group, Vec<Which>)| one.cmp(other));
    found
}

#[cfg(test)]
mod tests;
