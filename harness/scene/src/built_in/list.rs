//! The list of the built-in scenes: names, descriptions, and how each is made.

use super::{cut, materials, pave, prisms, ring, stone, translucent, tray, tumbler, vitrine};
use crate::polyhedron::Triangulation;
use crate::{Averaging, Scene, SceneError};

/// A scene that needs no file.
#[derive(Debug, Clone, Copy)]
pub struct BuiltIn {
    /// Name that a user types.
    pub name: &'static str,
    /// Description of the scene and its purpose, in one paragraph.
    pub description: &'static str,
    /// Makes the scene, by its name.
    pub(super) make: fn(&str) -> Result<Scene, SceneError>,
}

/// All built-in scenes.
pub const BUILT_IN: [BuiltIn; 35] = [
    BuiltIn {
        name: "brilliant",
        description: "A diamond in the round brilliant cut with Tolkowsky's proportions: 73 facets with \
            the girdle's 16. Seen from 27° off the table's axis, so that pavilion facets show through \
            the table. The stone to judge internal reflection and fire by.",
        make: |name| cut::brilliant(name, materials::diamond()),
    },
    BuiltIn {
        name: "sapphire",
        description: "A sapphire in the diamond's cut: corundum, royal blue by absorption along the way inside, \
            so that long ways are darker than short ones. The critical angle is 34.4° against diamond's 24.4°: \
            less light is kept in, and the dispersion is less than half.",
        make: |name| cut::brilliant(name, materials::sapphire()),
    },
    BuiltIn {
        name: "ruby",
        description: "A ruby in the diamond's cut, with the red of pigeon's blood. It is the sapphire's mineral, \
            with the same index and dispersion; the attenuation alone differs.",
        make: |name| cut::brilliant(name, materials::ruby()),
    },
    BuiltIn {
        name: "quartz",
        description: "Rock crystal in the diamond's cut. The pavilion's 40.75° hardly pass this mineral's critical \
            angle of 40.4°, so that much light leaves through the back at the first hit: why quartz is cut steeper, \
            and the stone in which a missed total reflection costs least.",
        make: |name| cut::brilliant(name, materials::quartz()),
    },
    BuiltIn {
        name: "octahedron",
        description: "A regular octahedron of diamond, the form of the rough crystal. Eight facets and \
            parallel opposite sides make every path inside easy to follow by hand.",
        make: cut::octahedron_of_diamond,
    },
    BuiltIn {
        name: "step_cut",
        description: "An emerald (beryl) in the step cut with cut corners: length to width 1.4, three \
            crown steps, three pavilion steps to a keel, 57 facets. Long parallel facets show the \
            straight flashes that a brilliant breaks up. Its bluish green comes by absorption along the way inside.",
        make: cut::step_cut_emerald,
    },
    BuiltIn {
        name: "prism",
        description: "A closed pentagonal prism of quartz with a pyramid at each end. No side has a \
            parallel opposite one, and at this low index much light leaves at the first hit.",
        make: cut::pentagonal_prism,
    },
    BuiltIn {
        name: "prism_chain",
        description: "The scene of the paper's Fig. 6: closed pentagonal prisms, here seven of quartz, hang from one \
            another by their tips, each turned and tilted by another angle. They are one mesh and one draw call. The \
            paper makes each prism's inside up from its own triangles (`--rung proxy-1`); the default traces it.",
        make: |name| Ok(cut::seen(name, prisms::chain()?, materials::quartz(), (78.0, 12.0))),
    },
    BuiltIn {
        name: "chandelier",
        description: "A chandelier of 384 pentagonal prisms of flint glass: six rings of pendants, wide and high to \
            narrow and low, and one in the middle, each a bead with a long drop below it. One mesh, one draw call, \
            7680 triangles: what games show as opaque mirrors, here with its inside, found through a hierarchy.",
        // From a little below, as one looks up at it, so that the inner rings show below the outer.
        make: |name| Ok(cut::seen(name, prisms::chandelier()?, materials::flint_glass(), (105.0, 9.0))),
    },
    BuiltIn {
        name: "pave_ring",
        description: "A band of 200 brilliants of corundum, set close in five rows round a ring, in all colours of \
            sapphire from violet to ruby. One shape, one draw call, 80 bytes for each stone.",
        make: pave::ring,
    },
    BuiltIn {
        name: "ring",
        description: "A ring of yellow gold on a dark cloth: a brilliant in six prongs, and five small ones in a channel in each \
            shoulder. Lit as jewellers do it, by softboxes, black flags and rows of small bright lights (`--environment jeweller`), and \
            by two lamps.",
        make: ring::ring,
    },
    BuiltIn {
        name: "tray",
        description: "A diamond that leans on its pavilion and an emerald on its table, on a red tray between a blue ball and a \
            yellow block, all matte. Half of what leaves the stones meets the tray, the things on it or the other stone: \
            the scene to judge `--outside` by.",
        make: tray::tray,
    },
    BuiltIn {
        name: "solitaire",
        description: "A diamond in four prongs on a band, matte as painted, over a dark plate. Bounds say little of a band: \
            what leaves the stone downwards starts inside the band's box.",
        make: tray::solitaire,
    },
    BuiltIn {
        name: "tumbler",
        description: "A glass of water with a straw, which breaks at the water, and a candle of wax behind a pane of frosted glass: bodies \
            within bodies, smooth, rough and scattering ones. Where water and glass overlap, the glass is there.",
        make: tumbler::tumbler,
    },
    BuiltIn {
        name: "bunny_stone",
        description: "The Stanford bunny as a solid of crown glass (Schott's N-BK7), 3674 triangles. \
            Concave: light leaves and enters again, which no convex method can follow.",
        make: cut::bunny_stone,
    },
    BuiltIn {
        name: "brilliant_fan",
        description: "The diamond with its table cut into six triangles that fan out from one corner, instead of \
            eight about its middle. The surface and the shared normals are the same, and so is the picture by exact facets: \
            only the proxy geometry (`--rung proxy-1`) draws another stone.",
        make: |name| cut::diamond(name, Averaging::default(), Triangulation::Fan),
    },
    BuiltIn {
        name: "brilliant_strip",
        description: "The diamond with its table cut into a zigzag of six triangles, as a triangle strip would run. \
            The surface and the shared normals are the same as with the table's fan.",
        make: |name| cut::diamond(name, Averaging::default(), Triangulation::Strip),
    },
    BuiltIn {
        name: "brilliant_sliver",
        description: "The diamond with its table cut into 150 needles, most with an angle of a few degrees, on the \
            same surface with the same shared normals. The paper names the defect of proxy geometry: an acute triangle makes the \
            inside acute too.",
        make: |name| cut::diamond(name, Averaging::default(), Triangulation::Sliver),
    },
    BuiltIn {
        name: "brilliant_area",
        description: "The diamond with its shared normals averaged by the facets' areas instead of their angles. The surface is the \
            same, and so is the stone by exact facets; the proxy's depth is not.",
        make: |name| cut::diamond(name, Averaging::Area, Triangulation::Centroid),
    },
    BuiltIn {
        name: "brilliant_plain",
        description: "The diamond with the plain average of the facets' normals at each vertex, as many exporters write it.",
        make: |name| cut::diamond(name, Averaging::Plain, Triangulation::Centroid),
    },
    BuiltIn {
        name: "skin",
        description: "Five spheres of human skin, with radii of 40, 24, 14, 8 and 5 mm, lit from the upper left: the smaller \
            the sphere, the further light creeps round into the shadow, and red further than blue.",
        make: |name| Ok(translucent::spheres(name)),
    },
    BuiltIn {
        name: "skin_ring",
        description: "A ring of human skin, lit by a sun and two lamps.",
        make: |name| Ok(translucent::ring(name)),
    },
    BuiltIn {
        name: "skin_bunny",
        description: "The Stanford bunny, 60 mm high, of human skin, in one light.",
        make: translucent::bunny,
    },
    BuiltIn {
        name: "wax",
        description: "Five spheres of wax, with radii of 40, 24, 14, 8 and 5 mm, lit from the upper left. Wax scatters all \
            colours alike.",
        make: |name| Ok(translucent::spheres(name)),
    },
    BuiltIn {
        name: "wax_ring",
        description: "A ring of wax, lit by a sun and two lamps.",
        make: |name| Ok(translucent::ring(name)),
    },
    BuiltIn {
        name: "wax_bunny",
        description: "The Stanford bunny, 60 mm high, of wax, in one light.",
        make: translucent::bunny,
    },
    BuiltIn {
        name: "jade",
        description: "Five polished spheres of green jade, with radii of 40, 24, 14, 8 and 5 mm, lit from the upper left.",
        make: |name| Ok(translucent::spheres(name)),
    },
    BuiltIn {
        name: "jade_ring",
        description: "A polished ring of green jade, lit by a sun and two lamps.",
        make: |name| Ok(translucent::ring(name)),
    },
    BuiltIn {
        name: "jade_bunny",
        description: "The Stanford bunny, 60 mm high, of polished green jade, in one light.",
        make: translucent::bunny,
    },
    BuiltIn {
        name: "skin_head",
        description: "Skin, the same everywhere, on a head: that of the scene `head` without its images, to compare with random walks, which \
            know the matter alone.",
        make: translucent::head,
    },
    BuiltIn {
        name: "head",
        description: "The head of Lee Perry-Smith, a scan that papers on skin show, 380 mm from crown to chest: its colour and its slopes \
            are images, under a warm light from the side and a cool one from behind.",
        make: translucent::head,
    },
    BuiltIn {
        name: "bunny",
        description: "The Stanford bunny of marble, 60 mm high, with parallel light from the left: through the ears it passes, the body \
            stops it.",
        make: stone::bunny,
    },
    BuiltIn {
        name: "dragon",
        description: "The Stanford dragon of veined jade, 50 mm high and 71 mm long, with parallel light from behind, which passes claws, crest \
            and tail.",
        make: stone::dragon,
    },
    BuiltIn {
        name: "figure",
        description: "A winged figure of marble on a plinth, 117 mm high, who raises a wreath; parallel light from behind at the left passes \
            wings, arms and wreath. Made of smooth joins of simple bodies.",
        make: stone::figure,
    },
    BuiltIn {
        name: "vitrine",
        description: "Clear stones, reflectance by curvature and diffusion in one picture: on a table of slate a diamond that \
            disperses light, a ruby that does not, a ball of jade, a candle of paraffin and the figure of veined marble; a chain of clear glass prisms hangs from a bronze stand. Lit by a sun from \
            behind at the left, which shines through wax and marble, and a weak warm lamp.",
        make: vitrine::stored,
    },
];

/// Returns the names of all built-in scenes, as a list for a message.
#[must_use]
pub fn names() -> String {
    BUILT_IN.map(|scene| scene.name).join(", ")
}

/// Other names that a user may well give to built-ins.
pub(super) const ALIASES: [(&str, &str); 2] = [("diamond", "brilliant"), ("emerald", "step_cut")];

/// Returns the built-in scene called `name`, also by an alias, or `None` if there is none.
pub(crate) fn named(name: &str) -> Option<&'static BuiltIn> {
    let meant = ALIASES.iter().find(|(alias, _)| *alias == name).map_or(name, |(_, meant)| meant);
    BUILT_IN.iter().find(|scene| scene.name == meant)
}
