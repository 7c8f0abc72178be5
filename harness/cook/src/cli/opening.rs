//! The scene of a command: opened, given the materials that were asked for, its stones parted.

use super::Failure;
use super::asked::Asked;
use super::opened::{Opened, distinct, refuse_twice};
use lapidary_files::nearest;
use lapidary_plan::Note;
use lapidary_scene::jewellery::{self, Guess};
use lapidary_scene::{Material, Object, Opening, Preset, Scene};

impl Asked {
    /// Opens the scene, with the materials and normals that were asked for, and the stones of a file mended, parted and joined
    /// to copies. The notes say what was changed.
    pub(super) fn open(&self) -> Result<Opened, Failure> {
        let (scene, presets) = self.scene_and_presets()?;
        let guesses = if self.jewellery { guesses(&scene, &presets) } else { Vec::new() };
        self.dressed(scene, presets, guesses)
    }

    /// Opens the scene in the same way, with notes on what looks like an unmarked stone or metal as well.
    pub(super) fn open_with_hints(&self) -> Result<Opened, Failure> {
        let (scene, presets) = self.scene_and_presets()?;
        let guesses = guesses(&scene, &presets);
        self.dressed(scene, presets, guesses)
    }

    /// Returns the scene as its file is, and the preset that `--material` gives each body.
    fn scene_and_presets(&self) -> Result<(Scene, Presets), Failure> {
        let opening = Opening { camera: self.camera.clone(), time: self.time };
        let scene = Scene::open_as(&self.scene, &opening)?;
        let presets = self.presets(&scene)?;
        Ok((scene, presets))
    }

    /// Gives the bodies of a scene their presets, and changes what was asked for.
    fn dressed(&self, mut scene: Scene, mut presets: Presets, guesses: Vec<Guess>) -> Result<Opened, Failure> {
        let mut notes = self.guessed(guesses, &mut presets);
        scene.lacking.replace(|body| presets[body].is_some());
        // A preset fits itself to a stone, which its mesh may hold many of: first that bodies are clear, and of one material.
        for (object, preset) in scene.objects.iter_mut().zip(&presets) {
            if let Some(preset) = preset {
                object.material = Material { name: preset.name.to_owned(), ..preset.material(1.0) };
            }
        }
        let names: Vec<String> = scene.objects.iter().map(|object| object.name.clone()).collect();
        let is_file = !Scene::sources(&self.scene).is_empty();
        let is_asked = |object: &Object| self.rung.iter().any(|(node, _)| node.as_ref() == Some(&object.name));
        let origins: Vec<usize> = if is_file && !self.as_modelled {
            let parting = scene.part_stones(is_asked);
            let recovered = scene.recover_stones();
            notes.extend(parting.notes.into_iter().chain(recovered).map(Note::Stones));
            parting.origins
        } else {
            (0..names.len()).collect()
        };
        for (object, origin) in scene.objects.iter_mut().zip(&origins) {
            if let Some(preset) = presets[*origin] {
                *object = preset.on(object);
            }
        }
        if let Some(normals) = self.normals {
            let clear: Vec<&mut Object> =
                scene.objects.iter_mut().filter(|object| object.material.is_clear()).collect();
            if clear.is_empty() {
                return Err(Failure(format!(
                    "scene `{}`: --normals is for clear bodies, and none is there; leave it out",
                    scene.name
                )));
            }
            clear.into_iter().for_each(|object| object.material.normals = normals);
        }
        let nodes = origins.into_iter().map(|origin| names[origin].clone()).collect();
        Ok(Opened { scene, notes, nodes })
    }

    /// Returns the preset that `--material` gives each body: that of the most exact name, and of equally exact ones the last.
    fn presets(&self, scene: &Scene) -> Result<Presets, Failure> {
        refuse_twice("--material", self.material.iter().map(|(node, _)| node.as_deref()))?;
        let names = Names::of(scene);
        let mut named = Vec::new();
        for (which, preset) in &self.material {
            let (exactness, bodies) = match which {
                None => (Exactness::All, vec![true; scene.objects.len()]),
                Some(which) => named_bodies(&names, which, "--material")?,
            };
            named.push((exactness, bodies, *preset));
        }
        named.sort_by_key(|(exactness, ..)| *exactness);
        let mut presets = vec![None; scene.objects.len()];
        for (_, bodies, preset) in named {
            for (of_body, _) in presets.iter_mut().zip(bodies).filter(|(_, is_meant)| *is_meant) {
                *of_body = Some(preset);
            }
        }
        Ok(presets)
    }

    /// Adds the presets of what unmarked bodies look like, if that was asked for, and returns notes on them.
    fn guessed(&self, guesses: Vec<Guess>, presets: &mut Presets) -> Vec<Note> {
        if !self.jewellery {
            return guesses.into_iter().map(Note::Unmarked).collect();
        }
        for (guess, preset) in guesses.iter().filter_map(|guess| Some((guess, guess.look.preset()?))) {
            guess.bodies.iter().for_each(|&body| presets[body] = Some(preset));
        }
        if guesses.is_empty() { vec![Note::NothingGuessed] } else { guesses.into_iter().map(Note::Guessed).collect() }
    }
}

/// The preset that each body is given.
type Presets = Vec<Option<&'static Preset>>;

/// Returns what the bodies without a preset look like.
fn guesses(scene: &Scene, presets: &Presets) -> Vec<Guess> {
    jewellery::guesses(scene, |body| presets[body].is_some())
}

/// What bodies are named by.
struct Names {
    scene: String,
    nodes: Vec<String>,
    materials: Vec<String>,
}

impl Names {
    fn of(scene: &Scene) -> Self {
        let of = |name: fn(&Object) -> &String| scene.objects.iter().map(|object| name(object).clone()).collect();
        Self {
            scene: scene.name.clone(),
            nodes: of(|object| &object.name),
            materials: of(|object| &object.material.name),
        }
    }
}

/// How exactly an option names bodies: the more exact name counts, wherever it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Exactness {
    /// All of them.
    All,
    /// Those of which a name follows a pattern.
    Pattern,
    /// Those of a material, by its name or number.
    Material,
    /// Those of a node.
    Node,
}

/// Whether a body is meant, by the names of its node and of its material.
type IsMeant<'a> = &'a dyn Fn(&str, &str) -> bool;

/// Returns how exactly bodies are named, and which are meant: those whose node has this name, or else whose material has it, or else, if it has no name, the
/// number, or else those of which either name follows the pattern. Refuses what names none.
fn named_bodies(
    Names { scene, nodes, materials }: &Names,
    which: &str,
    option: &str,
) -> Result<(Exactness, Vec<bool>), Failure> {
    // What the loader calls a material without a name.
    let numbered = format!("material {which}");
    let pattern = wildmatch::WildMatch::new(which);
    let follows = |name: &str| which.contains(['*', '?']) && pattern.matches(name);
    let ways: [(Exactness, IsMeant<'_>); 4] = [
        (Exactness::Node, &|node, _| node == which),
        (Exactness::Material, &|_, material| material == which),
        (Exactness::Material, &|_, material| material == numbered),
        (Exactness::Pattern, &|node, material| follows(node) || follows(material)),
    ];
    let meant = |is_meant: IsMeant<'_>| -> Vec<bool> {
        nodes.iter().zip(materials).map(|(node, material)| is_meant(node, material)).collect()
    };
    let mut ways = ways.into_iter().map(|(exactness, is_meant)| (exactness, meant(is_meant)));
    ways.find(|(_, meant)| meant.contains(&true)).ok_or_else(|| {
        let known = distinct(nodes.iter().chain(materials));
        Failure(format!(
            "scene `{scene}` has no node or material `{which}` for {option}{}",
            nearest::suggest(which, &known)
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_are_named_by_node_material_number_or_pattern() {
        let text = |names: [&str; 4]| names.map(str::to_owned).to_vec();
        let names = Names {
            scene: "ring".to_owned(),
            nodes: text(["band", "Gem.001", "Gem.002", "stone"]),
            materials: text(["gold", "material 2", "material 2", "Gem ruby"]),
        };
        let found = |which| named_bodies(&names, which, "--material").ok().map(|(_, bodies)| bodies);
        assert_eq!(found("band"), Some(vec![true, false, false, false]));
        assert_eq!(found("Gem ruby"), Some(vec![false, false, false, true]));
        assert_eq!(found("2"), Some(vec![false, true, true, false]));
        assert_eq!(found("Gem*"), Some(vec![false, true, true, true]));
        assert_eq!(found("?old"), Some(vec![true, false, false, false]));
        assert_eq!((found("gem*"), found("3"), found("bands")), (None, None, None));
        let message = named_bodies(&names, "Gem rubi", "--material").expect_err("none").0;
        assert!(message.contains("no node or material `Gem rubi`") && message.contains("`Gem ruby`"), "{message}");
    }

    /// A name wins over a pattern and a node over its material, in either order; of equal ones the last wins.
    #[test]
    fn the_more_exact_name_counts() {
        let preset = |name: &str| Preset::named(name).expect("a preset");
        let mut scene = Scene::named("brilliant").expect("built in");
        let one = scene.objects.remove(0);
        let object = |node: &str, material: &str| {
            let material = Material { name: material.to_owned(), ..one.material.clone() };
            Object { name: node.to_owned(), material, ..one.clone() }
        };
        scene.objects = vec![object("Gem.1", "Red"), object("Gem.2", "Red"), object("Gem.3", "Blue")];
        let given = |options: &[(Option<&str>, &str)]| {
            let option = |(which, name): &(Option<&str>, &str)| (which.map(str::to_owned), preset(name));
            let asked = Asked { material: options.iter().map(option).collect(), ..Asked::default() };
            let presets = asked.presets(&scene).expect("presets");
            presets.iter().map(|preset| preset.map_or("", |preset| preset.name)).collect::<Vec<_>>().join(" ")
        };
        let mut options =
            [(Some("Gem.1"), "ruby"), (Some("Red"), "emerald"), (Some("Gem*"), "quartz"), (None, "diamond")];
        for _ in 0..4 {
            assert_eq!(given(&options), "ruby emerald quartz", "{options:?}");
            options.rotate_left(1);
        }
        options.reverse();
        assert_eq!(given(&options), "ruby emerald quartz", "{options:?}");
        assert_eq!(given(&[(Some("Gem*"), "ruby"), (Some("*.2"), "quartz")]), "ruby quartz ruby");
        assert_eq!(given(&[(Some("*.2"), "quartz"), (Some("Gem*"), "ruby")]), "ruby ruby ruby");
        assert_eq!(given(&[(Some("Blue"), "quartz")]), "  quartz");
    }
}
