//! Bad usage and bad input: exit code 2, one clear line that names what is wrong, nothing on stdout, no file left behind.

use base64::Engine as _;
use lapidary_scene::{Scene, glb};
use lapidary_testing::program::cook;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// What stderr must look like.
#[derive(Clone, Copy, PartialEq)]
enum Lines {
    /// `cook: ` and one line.
    One,
    /// `cook: ` and naga's excerpt of the source, several lines.
    Excerpt,
}
use Lines::{Excerpt, One};

/// Arguments, where `{}` stands for a folder of bad files; what stderr looks like; what it must say.
type Row = (&'static str, Lines, &'static [&'static str]);

const RENDER: &[Row] = &[
    ("octahedron --size 0x0 --out {}/out.png", One, &["size 0x0", "1 to 8192"]),
    ("octahedron --size 9000x512 --out {}/out.png", One, &["size 9000x512", "1 to 8192"]),
    ("octahedron --size 512x --out {}/out.png", One, &["--size", "512x512"]),
    ("octahedron --size axb --out {}/out.png", One, &["--size", "axb"]),
    ("octahedron --size -1x5 --out {}/out.png", One, &["--size", "-1x5", "512x512"]),
    ("octahedron --size=-1x5 --out {}/out.png", One, &["--size", "-1x5"]),
    ("octahedron --size 99999999999x5 --out {}/out.png", One, &["--size", "99999999999x5"]),
    ("octahedron --exposure nan --out {}/out.png", One, &["--exposure", "above 0"]),
    ("octahedron --exposure inf --out {}/out.png", One, &["--exposure", "above 0"]),
    ("octahedron --exposure 0 --out {}/out.png", One, &["--exposure", "above 0"]),
    ("octahedron --rung proxy1 --out {}/out.png", One, &["--rung", "did you mean `proxy-1`"]),
    ("octahedron --quality better --out {}/out.png", One, &["--quality", "did you mean `best`?"]),
    (
        "octahedron --rung proxy-1 --quality best --out {}/out.png",
        One,
        &["--rung proxy-1", "--quality best", "leave one out"],
    ),
    ("octahedron --material rubi --out {}/out.png", One, &["--material", "did you mean `ruby`?"]),
    (
        "octahedron --material gem=ruby --out {}/out.png",
        One,
        &["no node or material `gem` for --material", "octahedron"],
    ),
    ("octahedron --rung gem=walk-8 --out {}/out.png", One, &["no node `gem` for --rung", "octahedron"]),
    ("octahedron --rung octahedron=walk --out {}/out.png", One, &["--rung", "a rung is"]),
    ("octahedron --rung walk-2 --rung walk-4 --out {}/out.png", One, &["--rung names all objects twice"]),
    ("octahedron --rung octahedron=reference --out {}/out.png", One, &["draws a whole scene"]),
    ("octahedron --rung reference --rung octahedron=walk-2 --out {}/out.png", One, &["leave one out"]),
    (
        "octahedron --rung octahedron=walk-2 --rung octahedron=walk-4 --out {}/out.png",
        One,
        &["names `octahedron` twice"],
    ),
    ("tray --material ball=ruby --material ball=jade --out {}/out.png", One, &["--material names `ball` twice"]),
    ("dragon --rung dragon=godunov-64 --quality best --out {}/out.png", One, &["nothing to choose"]),
    ("dragon --rung dragon=godunov-64 --with diffusion --out {}/out.png", One, &["--with diffusion has no meaning"]),
    ("tray --rung ball=walk-2 --out {}/out.png", One, &["--rung ball=walk-2", "for clear stones"]),
    ("octahedron --samples 9 --out {}/out.png", One, &["--samples", "9", "from 1 to"]),
    ("octahedron --samples -1 --out {}/out.png", One, &["--samples", "-1", "from 1 to"]),
    ("jade --rung reference --seed -1 --out {}/out.png", One, &["--seed", "-1", "from 0 to 18446744073709551615"]),
    ("jade --rung reference --walks -1 --out {}/out.png", One, &["--walks", "-1", "from 0 to 4294967295"]),
    ("octahedron --exposure -1 --out {}/out.png", One, &["--exposure", "-1", "above 0"]),
    ("octahedron --exposure -inf --out {}/out.png", One, &["--exposure", "-inf", "above 0"]),
    ("octahedron --wavelengths 7 --out {}/out.png", One, &["nothing there is drawn by the reference of clear stones"]),
    (
        "octahedron --rung surface --distance-limit 1 --out {}/out.png",
        One,
        &["nothing there is drawn by rays inside clear stones"],
    ),
    ("octahedron --rung reference --energy-bound -1 --out {}/out.png", One, &["energy"]),
    ("octahedron --rung reference --wavelengths 2 --out {}/out.png", One, &["2 wavelengths"]),
    ("octahedron --rung proxy-65 --out {}/out.png", One, &["--rung", "at most 64"]),
    ("octahedron --rung convex-1+2 --out {}/out.png", One, &["--rung", "3 to 61"]),
    ("bunny_stone --rung walk-2 --out {}/out.png", One, &["is not convex: it bends inwards at the edge from [", "bvh"]),
    ("bunny_stone --rung convex-2 --out {}/out.png", One, &["is not convex", "bvh"]),
    (
        "{}/open.gltf --rung convex-2 --out {}/out.png",
        One,
        &["is no closed solid (all corners lie in one plane)", "bvh"],
    ),
    ("skin --rung convex-2 --out {}/out.png", One, &["rung `convex-2` is for clear stones", "nothing there is one"]),
    ("wax --rung surface --out {}/out.png", One, &["rung `surface` is for clear stones", "take another"]),
    ("{}/metal.gltf --rung proxy-1 --out {}/out.png", One, &["rung `proxy-1` is for clear stones", "transmission"]),
    (
        "{}/polished.gltf --rung reference --size 8x8 --out {}/out.png",
        One,
        &["object `mesh 0`", "opaque and polished", "the reference"],
    ),
    ("octahedron --from 20 --out {}/out.png", One, &["--from", "20,11"]),
    ("octahedron --from nan,0 --out {}/out.png", One, &["--from", "degrees"]),
    ("octahedron --strength nan --out {}/out.png", One, &["--strength", "above 0"]),
    ("octahedron --distance-limit 0 --out {}/out.png", One, &["--distance-limit", "above 0"]),
    ("octahedron --without fire --out {}/out.png", One, &["--without", "absorption"]),
    ("octahedron --with cdrf --out {}/out.png", One, &["--with cdrf has no meaning", "scattering and absorption"]),
    ("bunny --with cdrf --rung lambert --out {}/out.png", One, &["a rung is asked for"]),
    ("octahedron --with shadow --out {}/out.png", One, &["--with shadow has no meaning", "lit by the environment"]),
    (
        "bunny --rung godunov-16 --with shadow --out {}/out.png",
        One,
        &["--with shadow has no meaning", "its source sees"],
    ),
    ("skin --rung reference --with shadow --out {}/out.png", One, &["knows no --with shadow"]),
    ("bunny --with cdrf,optical_path --out {}/out.png", One, &["by one of them"]),
    ("bunny --with fog --out {}/out.png", One, &["--with", "shadow"]),
    ("bunny --deferred --out {}/out.png", One, &["nothing there is drawn by the gem recipes"]),
    ("skin --rung drift --shadows soft --out {}/out.png", One, &["--shadows has no meaning", "no shadow"]),
    ("bunny --shadows soft --out {}/out.png", One, &["--shadows has no meaning"]),
    (
        "skin_bunny --rung drift --with half_space,shadow --without translucent_shadow --shadows soft --out {}/out.png",
        One,
        &["--shadows has no meaning", "left out"],
    ),
    ("skin_bunny --shadows hard --out {}/out.png", One, &["--shadows", "no such form of shadows"]),
    ("vitrine --deferred --out {}/out.png", One, &["only clear stones", "leave --deferred out"]),
    ("bunny --footprint --out {}/out.png", One, &["nothing there is drawn by the gem recipes"]),
    ("prism_chain --footprint --out {}/out.png", One, &["rung by-material", "leave --footprint out"]),
    ("brilliant --rung bvh-4 --footprint --out {}/out.png", One, &["rung bvh-4", "take --rung walk-8+tracker"]),
    ("brilliant --rung walk-4+3 --footprint --out {}/out.png", One, &["rung walk-4+3", "take --rung walk-8+tracker"]),
    ("brilliant --outside screen --out {}/out.png", One, &["--outside screen has no meaning", "all bodies are clear"]),
    ("brilliant --outside bodies --out {}/out.png", One, &["--outside bodies has no meaning", "all bodies are clear"]),
    ("bunny --outside bodies --out {}/out.png", One, &["nothing there is drawn by the gem recipes"]),
    ("tray --outside scren --out {}/out.png", One, &["--outside", "screen"]),
    ("tray --thickness 1 --out {}/out.png", One, &["--thickness", "--outside screen"]),
    ("tray --outside bodies --thickness 1 --out {}/out.png", One, &["--thickness", "--outside screen"]),
    ("tray --outside screen --thickness 0 --out {}/out.png", One, &["--thickness", "above 0"]),
    ("brilliant --deferred --footprint --out {}/out.png", One, &["--deferred", "--footprint"]),
    (
        "ruby --rung reference --without absorption --out {}/out.png",
        One,
        &["`reference` knows no --without absorption"],
    ),
    (
        "octahedron --rung reference --distance-limit 2 --out {}/out.png",
        One,
        &["nothing there is drawn by the gem recipes"],
    ),
    (
        "jade --walks-from lights --out {}/out.png",
        One,
        &["nothing there is drawn by the reference of scattering bodies"],
    ),
    ("jade --rung reference --walks-from light --out {}/out.png", One, &["did you mean `lights`"]),
    ("jade --size 8x8 --rung reference --walks-from lights --out {}/out.png", One, &["leave the environment out"]),
    (
        "jade --boundary dielectric --out {}/out.png",
        One,
        &["nothing there is drawn by the reference of scattering bodies"],
    ),
    ("octahedron --rung convex-1 --centre paper --out {}/out.png", One, &["nothing there is drawn by the proxy"]),
    (
        "octahedron --rung proxy-1 --strength 2 --out {}/out.png",
        One,
        &["nothing there is drawn by the paper's dispersion"],
    ),
    ("octahedron --rest lost --out {}/out.png", One, &["--rest", "dropped"]),
    ("octahedron --centre wrong --out {}/out.png", One, &["--centre", "stable"]),
];

const SCENES: &[Row] = &[
    ("{}/none.glb --out {}/out.png", One, &["none.glb: ", "cannot be read"]),
    ("{}/truncated.glb --out {}/out.png", One, &["truncated.glb: ", "damaged"]),
    ("{}/text.glb --out {}/out.png", One, &["text.glb: ", "not glTF"]),
    ("{}/empty.glb --out {}/out.png", One, &["empty.glb: ", "no triangles"]),
    ("{}/empty.gltf --out {}/out.png", One, &["empty.gltf: ", "no triangles"]),
    ("{}/nan.gltf --out {}/out.png", One, &["nan.gltf: ", "vertex 1 lies at (NaN", "finite"]),
    ("{}/index.gltf --out {}/out.png", One, &["index.gltf: ", "index 1 is 3", "3 vertices"]),
    ("{}/uv.gltf --out {}/out.png", One, &["uv.gltf: ", "vertex 1 has texture coordinates (0, NaN)", "finite"]),
    ("{}/spot.gltf --out {}/out.png", One, &["spot.gltf: ", "light 0 \"desk\"", "cone angles are 1.0 and 0.5"]),
    ("{}/dark.gltf --out {}/out.png", One, &["dark.gltf: ", "its intensity is -1.0", "at least 0"]),
    ("{}/half.gltf --out {}/out.png", One, &["half.gltf: ", "material 0 \"wax\"", "scattering but no absorption"]),
    ("{}/sigma.gltf --out {}/out.png", One, &["sigma.gltf: ", "material 0 \"wax\"", "sigma0 is [1,null,1]"]),
    ("{}/null.gltf --out {}/out.png", One, &["null.gltf: ", "material 0 \"wax\": its ior is null", "a number"]),
    ("{}/thickness.gltf --out {}/out.png", One, &["thickness.gltf: ", "its thicknessFactor is -1.0", "at least 0"]),
    ("{}/attenuation.gltf --out {}/out.png", One, &["attenuation.gltf: ", "its attenuationDistance is 0.0", "above 0"]),
    ("{}/dispersion.gltf --out {}/out.png", One, &["dispersion.gltf: ", "its dispersion is -0.1", "at least 0"]),
    ("{}/transmission.gltf --out {}/out.png", One, &["transmission.gltf: ", "transmissionFactor is 1.5", "0 to 1"]),
    ("{}/diffuse.gltf --out {}/out.png", One, &["diffuse.gltf: ", "diffuseTransmissionFactor is 2.0", "0 to 1"]),
    ("{}/unlit.gltf --out {}/out.png", One, &["KHR_materials_unlit excludes its KHR_materials_ior", "remove one"]),
    ("{}/mineral.gltf --out {}/out.png", One, &["its dispersion is 0.1", "corundum", "leave one of them out"]),
    ("{}/solver.gltf --out {}/out.png", One, &["its extras.lapidary.solver is \"bvh-8\"", "such as lambert"]),
    ("{}/unsolved.gltf --out {}/out.png", One, &["has a solver, but nothing there scatters", "remove the solver"]),
    ("{}/required.gltf --out {}/out.png", One, &["requires extensions", "VENDOR_x", "export it without"]),
    ("{}/cycle.gltf --out {}/out.png", One, &["cycle.gltf: node 0: it is reached twice", "remove the cycle"]),
    ("{}/uri.gltf --out {}/out.png", One, &["uri.gltf: buffer 0: its base64 is damaged", "export it again"]),
    ("{}/lost.gltf --out {}/out.png", One, &["lost.gltf: buffer 0's file", "none.bin", "cannot be read"]),
    ("{}/escape.gltf --out {}/out.png", One, &["escape.gltf: buffer 0: its uri", "leads out of the file's folder"]),
    ("{}/absolute.gltf --out {}/out.png", One, &["absolute.gltf: buffer 0: its uri", "not a relative path"]),
    ("{}/huge.gltf --out {}/out.png", One, &["huge.gltf: accessor 0: it has 178956970 elements", "export it again"]),
    ("{}/instances.gltf --out {}/out.png", One, &["its EXT_mesh_gpu_instancing has none of TRANSLATION", "give one"]),
    ("{}/counts.gltf --out {}/out.png", One, &["attributes have 3 and 1 elements", "give each as many"]),
    ("{}/crowd.gltf --out {}/out.png", One, &["accessor 0: it has 2147483648 elements", "export it again"]),
    ("{}/json.gltf --out {}/out.png", One, &["json.gltf: ", "not valid glTF", "line 1"]),
    ("{}/folder.glb --out {}/out.png", One, &["folder.glb: ", "it is a folder"]),
    ("briliant --out {}/out.png", One, &["`briliant`", "did you mean `brilliant`?"]),
    ("xyzzy --out {}/out.png", One, &["no scene is called `xyzzy`; give one of"]),
    ("octahedron --out {}/nowhere/out.png", One, &["cannot be written: its folder does not exist"]),
    ("dimond --out {}/out.png", One, &["`dimond`", "did you mean `brilliant`?"]),
    ("emrald --out {}/out.png", One, &["`emrald`", "did you mean `step_cut`?"]),
    ("{}/draco.gltf --out {}/out.png", One, &["its KHR_draco_mesh_compression cannot be decoded", "download it again"]),
    ("{}/quantised.gltf --out {}/out.png", One, &["accessor 0", "KHR_mesh_quantization in extensionsUsed"]),
    ("{}/first.gltf --out {}/out.png", One, &["first.gltf: it is of glTF version 1.0", "convert it"]),
    ("{}/empty_scene.gltf --out {}/out.png", One, &["empty_scene.gltf: ", "no triangles"]),
];

const OUTPUTS: &[Row] = &[
    ("octahedron --size 8x8 --out {}/out.jpg", One, &["out.jpg", ".png or .exr"]),
    ("octahedron --size 8x8 --out {}/out", One, &["out", ".png or .exr"]),
    ("octahedron --size 8x8 --out {}/none/out.png", One, &["none/out.png", "cannot be written"]),
    ("octahedron --size 8x8 --out {}/folder.png", One, &["folder.png", "cannot be written"]),
    // Below a file there is no folder, not even for root.
    ("octahedron --size 8x8 --out {}/text.glb/out.png", One, &["text.glb/out.png", "cannot be written"]),
    ("octahedron --size 8x8 --out {}/text.glb/out.exr", One, &["text.glb/out.exr", "cannot be written"]),
];

const ENVIRONMENTS: &[Row] = &[
    ("octahedron --size 8x8 --environment {}/none.exr --out {}/out.png", One, &["none.exr: ", "cannot be read"]),
    (
        "octahedron --size 8x8 --environment {}/text.hdr --out {}/out.png",
        One,
        &["text.hdr: ", "not a Radiance .hdr or OpenEXR .exr"],
    ),
    ("octahedron --size 8x8 --environment {}/folder.png --out {}/out.png", One, &["folder.png: ", "it is a folder"]),
];

const COMPARE: &[Row] = &[
    ("{}/none.exr {}/text.glb", One, &["none.exr: ", "cannot be read"]),
    ("{}/text.glb {}/text.glb", One, &["text.glb: ", "cannot be read", ".png or .exr"]),
    ("{}/text.glb", One, &["<PICTURE>"]),
];

const CORPUS: &[Row] = &[
    ("{}/none", One, &["none: ", "name a folder that can be read"]),
    ("{}/text.glb", One, &["text.glb: ", "name a folder that can be read"]),
    ("{} --environment {}/none.exr", One, &["none.exr: ", "cannot be read"]),
    ("{} --quality better", One, &["better", "`best`"]),
];

const CHECK: &[Row] = &[
    ("refracton", One, &["no module `refracton`", "did you mean `refraction`?"]),
    ("zzz", One, &["no module `zzz`", "refraction", "srgb"]),
    ("refraction::refrct", One, &["no function `refrct`", "did you mean `refraction::refract`"]),
    ("fresnel::dieletric", One, &["no function `dieletric`", "did you mean `fresnel::dielectric`"]),
    ("refraction --cases 0", One, &["--cases"]),
    ("refraction --cases -5", One, &["--cases", "-5", "from 1 to"]),
    ("refraction --seed -1", One, &["--seed", "-1", "from 0 to 18446744073709551615"]),
    ("refraction --seed x", One, &["--seed"]),
    ("refraction --wgsl {}/none.wgsl", One, &["none.wgsl: ", "cannot be read"]),
    ("refraction --wgsl {}/text.hdr", Excerpt, &["text.hdr:1:1"]),
    ("refraction::reflect --wgsl {}/syntax.wgsl", Excerpt, &["syntax.wgsl:3:", "expected"]),
    (
        "refraction::reflect --wgsl {}/type.wgsl",
        One,
        &["type.wgsl: ", "`refraction_reflect`", "argument `incident`", "expected vec3f, found f32"],
    ),
    ("refraction::refract --wgsl {}/type.wgsl", One, &["type.wgsl: ", "`refraction_refract` is missing"]),
    ("refraction --wgsl {}/type.wgsl", One, &["type.wgsl: ", "expected vec3f, found f32"]),
    ("fresnel --wgsl {}/type.wgsl", One, &["type.wgsl: ", "no function of module `fresnel`"]),
    ("refraction::reflect --failures {}/text.glb", One, &["text.glb/refraction_reflect.txt: ", "--failures DIR"]),
    ("--wgsl {}/other.wgsl", One, &["other.wgsl: ", "no function of the cookbook"]),
];

const OTHERS: &[Row] = &[
    ("frame brilliant", One, &["--out"]),
    ("frame brilliant --samples 9 --out {}/frame", One, &["expected a whole number from 1 to 8"]),
    ("frame brilliant --rung reference --out {}/frame", One, &["has no frame"]),
    ("frame brilliant --out {}", One, &["is there and not empty", "name a new folder"]),
    ("frame brilliant --out {}/text.glb/frame", One, &["text.glb"]),
    ("cost skin", One, &["unrecognized subcommand 'skin'"]),
    ("cost gem --from {}/none.json", One, &["none.json: ", "cannot be read"]),
    ("cost gem --from {}/text.glb", One, &["text.glb: ", "not a gem.json"]),
    ("cost gem --fill {}/none.md", One, &["none.md: ", "cannot be read"]),
    ("cost gem --rungs proxi-1", One, &["did you mean `proxy-1`"]),
    ("cost gem --rungs reference", One, &["compared with"]),
    ("cost gem --views briliant", One, &["did you mean `brilliant`"]),
    ("cost gem --walks 5", One, &["unexpected argument '--walks'"]),
    ("cost gem --seed 5", One, &["unexpected argument '--seed'"]),
    ("cost gem --rungs cheap", One, &["`gem` has no rung cheap", "./cook cost cdrf"]),
    ("cost cdrf --rungs proxy-1", One, &["`cdrf` has no rung proxy-1", "lambert"]),
    ("cost cdrf --rungs cheep", One, &["did you mean `cheap`"]),
    ("cost cdrf --views brilliant", One, &["unexpected argument '--views'"]),
    ("cost cdrf --walks 5", One, &["unexpected argument '--walks'"]),
    ("cost cdrf --seed 5", One, &["unexpected argument '--seed'"]),
    ("cost optical_path --rungs accurate", One, &["`optical_path` has no rung accurate", "godunov-64"]),
    ("cost optical_path --rungs reference", One, &["compared with"]),
    ("cost optical_path --views brilliant", One, &["unexpected argument '--views'"]),
    ("cost optical_path --walks 5", One, &["unexpected argument '--walks'"]),
    ("cost optical_path --from {}/empty.json", One, &["empty.json: ", "not a optical_path.json", "measure anew"]),
    ("cost cdrf --profile", One, &["unexpected argument '--profile'"]),
    ("cost cdrf --from {}/none.json", One, &["none.json: ", "cannot be read"]),
    ("cost cdrf --from {}/empty.json", One, &["empty.json: ", "not a cdrf.json", "measure anew"]),
    ("cost cdrf --from {}/untimed.json --fill {}/ladder.md", One, &["ladder.md: ", "no time of `lambert`"]),
    ("cost cdrf --fill {}/bad.md", One, &["bad.md: ", "no table `other`", "cdrf_lit"]),
    ("cost cdrf --out {}/text.glb/cost", One, &["text.glb/cost", "cannot be made"]),
    ("cost gem --out {}/text.glb/cost", One, &["text.glb/cost", "cannot be made"]),
    ("chek", One, &["chek", "check"]),
    ("list --jsn", One, &["--jsn"]),
    ("list --scenes --rungs", One, &["--scenes", "--rungs"]),
    ("completions csh", One, &["csh", "bash"]),
    ("copy", One, &["MODULE"]),
    ("copy refracton --out {}/out.wgsl", One, &["`refracton`", "did you mean `refraction`?"]),
    ("copy refraction gem --out {}/out.wgsl", One, &["`gem` is a recipe"]),
    ("copy refraction --effects absorption --out {}/out.wgsl", One, &["--effects"]),
    ("copy refraction --to nonsense --out {}/out.wgsl", One, &["--to", "hlsl"]),
    ("copy refraction --to spirv --out {}/out.spv", One, &["refraction::"]),
    ("copy refraction::reflekt --out {}/out.wgsl", One, &["`reflekt`", "did you mean"]),
    ("copy gem::gem_fragmet --out {}/out.wgsl", One, &["no function `gem_fragmet`", "did you mean"]),
    (
        "copy gem_walk::gem_footprint_start --effects convex_trace --out {}/out.wgsl",
        One,
        &["gem_footprint_start`", "--effects"],
    ),
    ("copy gem::gem_trace --to hlsl --out {}/out.hlsl", One, &["belong to an entry point", "gem::gem_fragment"]),
    ("copy gem gem_walk --out {}/out.wgsl", One, &["copy it alone"]),
    ("copy gem --effects dispersal --out {}/out.wgsl", One, &["no effect `dispersal`", "did you mean `dispersion`?"]),
    ("copy gem --set BOUNCE=8 --out {}/out.wgsl", One, &["no override `BOUNCE`", "did you mean `BOUNCES`?"]),
    ("copy gem --set BOUNCES --out {}/out.wgsl", One, &["--set BOUNCES", "BOUNCES=8"]),
    ("copy gem --set BOUNCES=-8 --out {}/out.wgsl", One, &["`BOUNCES` is of type u32", "`-8`"]),
    ("copy gem::gem_radiance --private vew --out {}/out.wgsl", One, &["no binding `vew`", "did you mean `view`?"]),
    (
        "copy gem::gem_centre --private normals --out {}/out.wgsl",
        One,
        &["`normals` is an array without a length", "normals[1]"],
    ),
    ("copy gem --private view --to msl --out {}/out.metal", One, &["--private is for WGSL"]),
    ("copy gem --private view --out {}/out.wgsl", One, &["--private", "nobody has set", "gem::FUNCTION"]),
    ("copy gem --set BOUNCES=8,BOUNCES=4 --out {}/out.wgsl", One, &["`BOUNCES` is set twice"]),
    ("copy gem --set =8 --out {}/out.wgsl", One, &["--set =8", "BOUNCES=8"]),
    ("copy gem --effects absorption --set EFFECT_ABSORPTION=false --out {}/out.wgsl", One, &["--effects says"]),
    ("copy gem --group 03 --out {}/out.wgsl", One, &["--group 03"]),
    ("copy gem --group fn --out {}/out.wgsl", One, &["--group fn"]),
    ("copy voxelize::word --out {}/out.wgsl", One, &["no function `word`", "voxelize_words"]),
    ("copy gem::gem_radiance --private environment_map --out {}/out.wgsl", One, &["`environment_map` is a texture"]),
    ("copy gem --group 3rd --out {}/out.wgsl", One, &["--group 3rd", "#{MATERIAL_BIND_GROUP}"]),
    ("copy refraction --set BOUNCES=8 --out {}/out.wgsl", One, &["--set is for a recipe"]),
    (
        "copy voxelize::voxelize_finish --to glsl-es --out {}/out.glsl",
        One,
        &["`voxelize::voxelize_finish`", "compute shaders"],
    ),
    (
        "copy gem::gem_vertex --to glsl-es --out {}/out.glsl",
        One,
        &["`gem::gem_vertex`", "storage buffers (`positions`"],
    ),
    ("copy gem --to glsl --out {}/out.glsl", One, &["gem::"]),
    ("copy refraction --out {}/none/out.wgsl", One, &["none/out.wgsl", "cannot be written"]),
    ("copy refraction --out {}/text.glb/out.wgsl", One, &["text.glb/out.wgsl", "cannot be written"]),
    ("scene brilliant --out {}/out.png", One, &["the name must end in .glb"]),
    ("scene briliant --out {}/out.glb", One, &["did you mean `brilliant`?"]),
    ("scene brilliant --out {}/text.glb/out.glb", One, &["text.glb/out.glb", "cannot be written"]),
    ("scene brilliant", One, &["--out"]),
];

#[test]
fn pictures_that_cannot_be_compared_are_refused() {
    all_refused("compare", COMPARE);
}

#[test]
fn a_corpus_without_files_or_with_bad_settings_is_refused() {
    all_refused("corpus", CORPUS);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let answer = cook(folder.path(), &["corpus", "."]);
    assert!(answer.code == Some(2) && answer.stderr.contains("has no .glb or .gltf file"), "{answer:?}");
}

#[test]
fn render_refuses_bad_settings() {
    all_refused("render", RENDER);
}

#[test]
fn render_refuses_bad_scenes() {
    all_refused("render", SCENES);
}

#[test]
fn render_refuses_places_where_nothing_can_be_written() {
    all_refused("render", OUTPUTS);
}

#[test]
fn render_refuses_bad_environments() {
    all_refused("render", ENVIRONMENTS);
}

#[test]
fn check_refuses_bad_names_and_sources() {
    all_refused("check", CHECK);
}

#[test]
fn the_other_commands_refuse_bad_input() {
    all_refused("", OTHERS);
}

fn all_refused(command: &str, rows: &[Row]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write_bad_files(folder.path());
    let before = files(folder.path());
    for (arguments, lines, says) in rows {
        let place = folder.path().to_str().expect("a path in UTF-8");
        let words: Vec<String> = command
            .split_whitespace()
            .chain(arguments.split_whitespace())
            .map(|word| word.replace("{}", place))
            .collect();
        let answer = cook(folder.path(), &words);
        let what = format!("{command} {arguments}: {answer:#?}");
        assert_eq!(answer.code, Some(2), "{what}");
        assert_eq!(answer.stdout, "", "{what}");
        assert!(!answer.stderr.contains("panicked"), "{what}");
        for part in *says {
            assert!(answer.stderr.contains(part), "`{part}` is not said by {what}");
        }
        let count = answer.stderr.trim_end().lines().count();
        match lines {
            One => assert!(answer.stderr.starts_with("cook: ") && count == 1, "not one line: {what}"),
            Excerpt => assert!(answer.stderr.starts_with("cook: ") && count > 1, "{what}"),
        }
        // Neither the output nor a part of it under another name.
        assert_eq!(files(folder.path()), before, "{what}");
    }
}

/// Everything below a folder.
fn files(folder: &Path) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path));
        }
        found.insert(path);
    }
    found
}

fn write_bad_files(folder: &Path) {
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).expect("a file");
    let stone = glb::write(&Scene::named("octahedron").expect("a built-in scene")).expect("a .glb");
    write("truncated.glb", &stone[..stone.len() / 2]);
    write("text.glb", b"solid stone");
    write("text.hdr", b"solid stone");
    write("json.gltf", b"{\"asset\": ");
    let empty = json!({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}).to_string();
    write("empty.gltf", empty.as_bytes());
    write("empty.glb", &json_only_glb(&empty));
    write("nan.gltf", triangle([0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0, 0.0, 1.0, 0.0], [0, 1, 2]).to_string().as_bytes());
    write("index.gltf", triangle(CORNERS, [0, 3, 2]).to_string().as_bytes());
    for (name, change) in BAD_MEMBERS {
        let mut document = triangle(CORNERS, [0, 1, 2]);
        change(&mut document);
        write(name, document.to_string().as_bytes());
    }
    write("syntax.wgsl", b"fn refraction_reflect(incident: vec3f, normal: vec3f) -> vec3f {\n    return incident\n}\n");
    write(
        "type.wgsl",
        b"fn refraction_reflect(incident: f32, normal: vec3f) -> vec3f {\n    return incident * normal;\n}\n",
    );
    write("other.wgsl", b"fn mine(incident: vec3f) -> vec3f {\n    return incident;\n}\n");
    let report =
        |technique: &str| json!({"technique": technique, "adapter": "", "settings": {}, "rows": []}).to_string();
    write("empty.json", report("sphere").as_bytes());
    write("untimed.json", report("cdrf").as_bytes());
    write("ladder.md", b"<!-- generated: cdrf_lit --><!-- end -->\n");
    write("bad.md", b"<!-- generated: other --><!-- end -->\n");
    std::fs::create_dir(folder.join("folder.png")).expect("a folder");
    std::fs::create_dir(folder.join("folder.glb")).expect("a folder");
}

/// A binary glTF of a JSON chunk alone.
fn json_only_glb(json: &str) -> Vec<u8> {
    let mut text = json.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = |bytes: usize| u32::try_from(bytes).expect("a small file").to_le_bytes();
    [b"glTF".as_slice(), &length(2), &length(20 + text.len()), &length(text.len()), b"JSON", &text].concat()
}

/// The corners of a right triangle.
const CORNERS: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

type Change = fn(&mut Value);

/// Files with one fault, each as a change to a good one.
const BAD_MEMBERS: &[(&str, Change)] = &[
    ("uv.gltf", |d| {
        let uvs = [0.0, 0.0, 0.0, f32::NAN, 1.0, 0.0].into_iter().flat_map(f32::to_le_bytes);
        let data = base64::engine::general_purpose::STANDARD.encode(uvs.collect::<Vec<u8>>());
        let uri = format!("data:application/octet-stream;base64,{data}");
        d["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(2);
        let add = |list: &mut Value, item: Value| list.as_array_mut().expect("a list").push(item);
        add(&mut d["accessors"], json!({"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"}));
        add(&mut d["bufferViews"], json!({"buffer": 1, "byteLength": 24}));
        add(&mut d["buffers"], json!({"byteLength": 24, "uri": uri}));
    }),
    ("spot.gltf", |d| {
        add_light(d, json!({"type": "spot", "name": "desk", "spot": {"innerConeAngle": 1.0, "outerConeAngle": 0.5}}))
    }),
    ("dark.gltf", |d| add_light(d, json!({"type": "point", "intensity": -1}))),
    ("half.gltf", |d| add_wax(d, json!({"scattering": [1, 1, 1]}))),
    ("sigma.gltf", |d| add_wax(d, json!({"sigma0": [1, null, 1]}))),
    ("null.gltf", |d| extend_wax(d, json!({"KHR_materials_ior": {"ior": null}}))),
    ("thickness.gltf", |d| extend_wax(d, json!({"KHR_materials_volume": {"thicknessFactor": -1}}))),
    ("attenuation.gltf", |d| extend_wax(d, json!({"KHR_materials_volume": {"attenuationDistance": 0}}))),
    ("dispersion.gltf", |d| extend_wax(d, json!({"KHR_materials_dispersion": {"dispersion": -0.1}}))),
    ("transmission.gltf", |d| extend_wax(d, json!({"KHR_materials_transmission": {"transmissionFactor": 1.5}}))),
    ("diffuse.gltf", |d| {
        extend_wax(d, json!({"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 2}}))
    }),
    ("unlit.gltf", |d| extend_wax(d, json!({"KHR_materials_unlit": {}, "KHR_materials_ior": {}}))),
    ("mineral.gltf", |d| {
        add_wax(d, json!({"sellmeier": "corundum"}));
        d["materials"][0]["extensions"] = json!({"KHR_materials_dispersion": {"dispersion": 0.1}});
    }),
    ("solver.gltf", |d| add_wax(d, json!({"sigma0": [1, 1, 1], "solver": "bvh-8"}))),
    ("unsolved.gltf", |d| add_wax(d, json!({"solver": "accurate"}))),
    ("required.gltf", |d| d["extensionsRequired"] = json!(["VENDOR_x"])),
    ("cycle.gltf", |d| d["nodes"][0]["children"] = json!([0])),
    ("uri.gltf", |d| d["buffers"][0]["uri"] = json!("data:application/octet-stream;base64,!!!")),
    ("lost.gltf", |d| d["buffers"][0]["uri"] = json!("none.bin")),
    ("escape.gltf", |d| d["buffers"][0]["uri"] = json!("%2e%2e/text.hdr")),
    ("absolute.gltf", |d| d["buffers"][0]["uri"] = json!("/dev/zero")),
    ("huge.gltf", |d| d["accessors"][0]["count"] = json!(178_956_970)),
    ("open.gltf", |d| {
        extend_wax(
            d,
            json!({"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1}}),
        )
    }),
    ("metal.gltf", |d| extend_wax(d, json!({}))),
    ("polished.gltf", |d| {
        extend_wax(d, json!({}));
        d["materials"][0]["pbrMetallicRoughness"] = json!({"metallicFactor": 0, "roughnessFactor": 0});
    }),
    ("draco.gltf", |d| {
        d["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
        d["meshes"][0]["primitives"][0]["extensions"] =
            json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}});
    }),
    ("quantised.gltf", |d| {
        // Quantised without a word.
        d["accessors"][0]["componentType"] = json!(5122);
    }),
    ("first.gltf", |d| {
        d["asset"] = json!({"version": "1.0"});
        d["meshes"] = json!({"mesh": {"primitives": []}});
        d["nodes"] = json!({"node": {"meshes": ["mesh"]}});
    }),
    ("empty_scene.gltf", |d| d["scenes"] = json!([{"name": "nothing"}])),
    ("instances.gltf", |d| instance(d, json!({}))),
    ("counts.gltf", |d| {
        let mut one = d["accessors"][0].clone();
        one["count"] = json!(1);
        d["accessors"].as_array_mut().expect("a list").push(one);
        instance(d, json!({"TRANSLATION": 0, "SCALE": 2}));
    }),
    ("crowd.gltf", |d| {
        d["accessors"][0]["count"] = json!(1u64 << 31);
        instance(d, json!({"TRANSLATION": 0}));
    }),
];

fn instance(document: &mut Value, attributes: Value) {
    document["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
}

fn extend_wax(document: &mut Value, extensions: Value) {
    add_wax(document, json!({}));
    document["materials"][0]["extensions"] = extensions;
}

fn add_light(document: &mut Value, light: Value) {
    document["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
    document["nodes"][0]["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
}

fn add_wax(document: &mut Value, members: Value) {
    document["materials"] = json!([{"name": "wax", "extras": {"lapidary": members}}]);
    document["meshes"][0]["primitives"][0]["material"] = json!(0);
}

/// A glTF file of one triangle, its data in the JSON.
fn triangle(corners: [f32; 9], indices: [u16; 3]) -> Value {
    let corners = corners.into_iter().flat_map(f32::to_le_bytes);
    let binary: Vec<u8> = corners.chain(indices.into_iter().flat_map(u16::to_le_bytes)).collect();
    let data = base64::engine::general_purpose::STANDARD.encode(&binary);
    json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
        "buffers": [{"byteLength": 42, "uri": format!("data:application/octet-stream;base64,{data}")}],
    })
}

#[test]
fn the_triangle_that_the_bad_files_vary_is_good() {
    let good = triangle(CORNERS, [0, 1, 2]).to_string();
    let scene = lapidary_scene::gltf::parse(good.as_bytes(), None).expect("a triangle");
    assert_eq!(scene.triangle_count(), 1);
}

#[test]
#[cfg(target_os = "linux")]
fn a_stdout_that_takes_nothing_is_no_panic() {
    for arguments in [
        ["list", "--json"].as_slice(),
        &["list"],
        &["copy", "refraction"],
        &["check", "refraction::reflect", "--cases", "1000"],
    ] {
        let runtime = tempfile::tempdir().expect("a temporary folder");
        // Every write to it fails, as on a full disk.
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_cook"))
            .args(arguments)
            .env("XDG_RUNTIME_DIR", runtime.path())
            .stdout(full)
            .output()
            .expect("the binary starts");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert_eq!(stderr.trim_end().lines().count(), 1, "{arguments:?}: {stderr}");
    }
}
