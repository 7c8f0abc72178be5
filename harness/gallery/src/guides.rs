//! The guides: the doc pages that belong to no single module or recipe.

/// A guide.
#[derive(Clone, Copy, Debug)]
pub struct Guide {
    /// Name of its page on the site.
    pub name: &'static str,
    /// Its file in the repository.
    pub file: &'static str,
    /// Its short title.
    pub title: &'static str,
    /// Names of the ladders that it shows first.
    pub ladders: &'static [&'static str],
}

const fn guide(name: &'static str, file: &'static str, title: &'static str) -> Guide {
    Guide { name, file, title, ladders: &[] }
}

/// What to read to take and to choose.
pub const GUIDES: [Guide; 22] = [
    guide("choosing", "docs/choosing.md", "Which rung to choose"),
    guide("using", "docs/using.md", "Using the cookbook"),
    guide("modules", "docs/modules.md", "All modules"),
    guide("gem", "docs/gem.md", "Clear stones in full"),
    guide("cdrf_shading", "docs/cdrf_shading.md", "Skin, wax and jade in full"),
    guide("optical_path_shading", "docs/optical_path_shading.md", "Optical paths in full"),
    guide("gem_proxy", "docs/gem_proxy.md", "Where the proxy is wrong"),
    guide("plan", "docs/plan.md", "Only the effects a scene calls for"),
    guide("scene_files", "docs/scene_files.md", "Scene files"),
    Guide {
        ladders: &["convex", "concave"],
        ..guide("gem_ladder", "docs/gem_ladder.md", "The ladder of clear stones")
    },
    Guide { ladders: &["cdrf"], ..guide("cdrf_ladder", "docs/cdrf_ladder.md", "The ladder of reflectance") },
    Guide {
        ladders: &["optical_path"],
        ..guide("optical_path_ladder", "docs/optical_path_ladder.md", "The ladder of optical paths")
    },
    guide("ladders", "docs/ladders.md", "How ladders are measured"),
    guide("check", "docs/check.md", "Check your own copy"),
    guide("frame", "docs/frame.md", "A frame as data"),
    guide("languages", "docs/languages.md", "GLSL, HLSL, Metal, SPIR-V"),
    guide("drivers", "docs/drivers.md", "Where drivers differ"),
    guide("contract", "docs/contract.md", "The module contract"),
    guide("glossary", "docs/glossary.md", "Glossary"),
    guide("architecture", "docs/ARCHITECTURE.md", "How the parts fit together"),
    guide("contributing", "CONTRIBUTING.md", "Add a technique"),
    guide("recipes", "docs/recipes/README.md", "All recipes for hosts"),
];

/// Examples for engines, and the pages of the languages.
pub const ENGINES: [Guide; 10] = [
    guide("engines", "docs/engines/README.md", "Engines"),
    guide("engine_webgpu", "docs/engines/webgpu/README.md", "Plain WebGPU"),
    guide("engine_three", "docs/engines/three/README.md", "three.js"),
    guide("engine_wgpu", "docs/engines/wgpu/README.md", "wgpu"),
    guide("engine_bevy", "docs/engines/bevy/README.md", "Bevy"),
    guide("engine_drei", "docs/engines/drei/README.md", "Beside drei's diamond"),
    guide("glsl", "docs/languages/glsl.md", "GLSL"),
    guide("glsl_es", "docs/languages/glsl_es.md", "GLSL ES"),
    guide("hlsl", "docs/languages/hlsl.md", "HLSL"),
    guide("msl", "docs/languages/msl.md", "Metal"),
];
