//! Modules, functions and recipes in other shading languages. Khronos's compiler accepts the GLSL and
//! the HLSL, and its validator the SPIR-V; there is none for Metal outside of Apple's systems, where
//! naga's own checks are all.
//!
//! If the tools are not on the PATH, what needs them says so and passes. With `LAPIDARY_GLSLANG=required`,
//! as in `.ci/run`, it fails.

use lapidary_assay::dispatch::{self, KernelModule};
use lapidary_cook::formulas;
use lapidary_cookbook::{Module, modules};
use lapidary_translate::declarations::{declarations, of_functions, words};
use lapidary_translate::{Language, TranslateError, library, shader, spirv};
use lapidary_wgsl::{RECIPES, Recipe};
use lapidary_xtask::dist;
use naga::ShaderStage;
use rayon::prelude::*;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

/// Variable with the value `required` if a missing compiler is a failure.
const VARIABLE: &str = "LAPIDARY_GLSLANG";
/// Khronos's compiler of GLSL and HLSL, and its validator of SPIR-V.
const TOOLS: [&str; 2] = ["glslangValidator", "spirv-val"];

/// Returns whether the tools are there; says that `skipped` is not checked if they are not.
fn has_tools(skipped: &str) -> bool {
    let is_there =
        |tool: &&str| Command::new(tool).arg("--version").output().is_ok_and(|output| output.status.success());
    let missing: Vec<&str> = TOOLS.into_iter().filter(|tool| !is_there(tool)).collect();
    if !missing.is_empty() {
        let required = std::env::var_os(VARIABLE).is_some_and(|value| value == "required");
        assert!(!required, "{VARIABLE}=required: no {} on the PATH", missing.join(" and "));
        let _ = writeln!(std::io::stderr(), "{skipped} not compiled: no {} on the PATH", missing.join(" and "));
    }
    missing.is_empty()
}

/// Unless the suite is run whole, one function in this many is compiled alone.
const ONE_IN: u64 = 8;

/// How a text is compiled.
#[derive(Clone, Copy)]
enum As {
    /// Library text: an empty entry point is put below it.
    Library,
    /// A whole shader of a stage, whose entry point is named.
    Shader(ShaderStage, &'static str),
}

/// Compiles a text; the message says why it could not be. Only for languages that the compiler knows.
fn compiled(text: &str, language: Language, how: As, folder: &Path, name: &str) -> Result<(), String> {
    let stage = match how {
        As::Shader(ShaderStage::Vertex, _) => "vert",
        As::Shader(ShaderStage::Compute, _) => "comp",
        As::Shader(..) => "frag",
        As::Library if language == Language::GlslEs => "frag",
        As::Library => "comp",
    };
    let (source, output) = (folder.join(format!("{name}.{stage}")), folder.join(format!("{name}.spv")));
    let whole = match (language, how) {
        (Language::Glsl, As::Library) => {
            format!("#version 450\n{text}\nlayout(local_size_x = 1) in;\nvoid main() {{}}\n")
        }
        (Language::GlslEs, As::Library) => format!("#version 300 es\n{text}\nvoid main() {{}}\n"),
        (Language::Hlsl, As::Library) => format!("{text}\n[numthreads(1, 1, 1)]\nvoid main() {{}}\n"),
        _ => text.to_owned(),
    };
    std::fs::write(&source, whole).map_err(|error| error.to_string())?;
    let mut command = Command::new(TOOLS[0]);
    match (language, how) {
        // Vulkan's rules, and its SPIR-V.
        (Language::Glsl, As::Library) => command.arg("-V"),
        // OpenGL's rules: its built-in values have other names in Vulkan.
        (Language::Glsl, _) => command.args(["-G", "--auto-map-locations"]),
        (Language::Hlsl, As::Shader(_, entry)) => command.args(["-D", "-V", "-e", entry]),
        (Language::Hlsl, As::Library) => command.args(["-D", "-V", "-e", "main"]),
        _ => &mut command,
    };
    let has_spirv = language != Language::GlslEs;
    if has_spirv {
        command.arg("-o").arg(&output);
    }
    run(command.arg(&source))?;
    if has_spirv {
        let environment =
            if matches!((language, how), (Language::Glsl, As::Shader(..))) { "opengl4.5" } else { "vulkan1.1" };
        run(Command::new(TOOLS[1]).args(["--target-env", environment]).arg(&output))?;
    }
    Ok(())
}

fn run(command: &mut Command) -> Result<(), String> {
    let output = command.output().map_err(|error| error.to_string())?;
    if output.status.success() {
        return Ok(());
    }
    let text = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
    Err(format!("{command:?}: {text}"))
}

const COMPILED: [Language; 3] = [Language::Glsl, Language::GlslEs, Language::Hlsl];

fn of_module(module: &Module, language: Language) -> String {
    library(module.source, module.name, language).unwrap_or_else(|error| panic!("{}: {error}", module.name))
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

#[test]
fn a_module_keeps_its_names_and_comments_in_every_language() {
    for module in modules() {
        let lines: Vec<&str> = module.source.lines().collect();
        let declarations = declarations(&lines);
        for language in Language::ALL {
            let text = of_module(module, language);
            let place = format!("{} in {language}", module.name);
            let found: Vec<&str> = text.lines().collect();
            for declaration in &declarations {
                // Comments stand together, above what they describe.
                let comment = declaration.comment();
                let is_there = found.windows(comment.len().max(1)).any(|lines| lines == comment);
                assert!(comment.is_empty() || is_there, "{place}: {comment:?}");
                let Some(name) = declaration.name else { continue };
                let code = |line: &&&str| !line.trim_start().starts_with("//");
                assert!(
                    found.iter().filter(code).any(|line| words(line).any(|word| word == name)),
                    "{place}: `{name}`"
                );
            }
            // The members' comments too.
            for line in lines.iter().filter(|line| line.starts_with("    //")) {
                let in_struct = declarations.iter().any(|declaration| {
                    declaration.lines.contains(line) && declaration.lines.iter().any(|line| line.starts_with("struct "))
                });
                assert!(!in_struct || found.contains(line), "{place}: {line}");
            }
            assert!(!text.contains(" main(") && !text.contains("naga_") && !text.contains("fake"), "{place}");
        }
    }
}

#[test]
fn texts_of_all_modules_stand_in_one_file() {
    if !has_tools("the modules in other languages") {
        return;
    }
    let folder = folder();
    for language in COMPILED {
        // What is wrong is seen.
        assert!(compiled("float wrong( {", language, As::Library, folder.path(), "wrong").is_err(), "{language}");
        let forwards: Vec<String> = modules().iter().map(|module| of_module(module, language)).collect();
        let backwards: Vec<String> = forwards.iter().rev().cloned().collect();
        for (order, texts) in [("forwards", forwards), ("backwards", backwards)] {
            let name = format!("{order}{}", language.extension());
            let found = compiled(&texts.join("\n"), language, As::Library, folder.path(), &name);
            assert_eq!(found, Ok(()), "{language}");
        }
    }
}

#[test]
fn every_function_compiles_alone_in_every_language() {
    let has_tools = has_tools("the functions in other languages");
    let folder = folder();
    assert!(formulas::all().len() > 200, "{}", formulas::all().len());
    // Whole modules compile above; that each function brings what it needs does not depend on the language.
    let functions = lapidary_testing::sampled(formulas::all(), ONE_IN);
    let faults: Vec<String> = functions
        .par_iter()
        .flat_map(|formula| {
            let module = modules().iter().find(|module| module.name == formula.module).expect("a formula's module");
            let alone = of_functions(module.whole, &[formula.function]).expect("a function of the module");
            let mut faults = Vec::new();
            for language in Language::ALL {
                match library(&alone, module.name, language) {
                    Err(error) => faults.push(format!("{}: {error}", formula.function)),
                    Ok(text) if has_tools && COMPILED.contains(&language) => {
                        let name = format!("{}_{language:?}", formula.function);
                        faults.extend(compiled(&text, language, As::Library, folder.path(), &name).err());
                    }
                    Ok(_) => {}
                }
            }
            let kernel = KernelModule::reflect(module.whole, module.name, formula.function).expect("valid WGSL");
            let words = spirv(&kernel.module).unwrap_or_else(|error| panic!("{}: {error}", formula.function));
            if has_tools {
                let path: PathBuf = folder.path().join(format!("{}.kernel.spv", formula.function));
                std::fs::write(&path, words).expect("a file");
                faults.extend(run(Command::new(TOOLS[1]).args(["--target-env", "vulkan1.1"]).arg(&path)).err());
            }
            faults
        })
        .collect();
    assert!(faults.is_empty(), "{} faults, the first:\n{}", faults.len(), faults[..faults.len().min(8)].join("\n"));
}

/// An entry point of a recipe in a language: its text, or why there is none.
struct Shown {
    place: String,
    language: Language,
    stage: ShaderStage,
    entry: &'static str,
    text: Result<String, TranslateError>,
}

/// Every entry point in every language, translated once for all tests.
static SHOWN: LazyLock<Vec<Shown>> = LazyLock::new(|| {
    let points = RECIPES.iter().flat_map(|recipe| {
        let source = recipe.compose();
        let (ir, _) = dispatch::parse(&source, recipe.name).expect("valid WGSL");
        let points = ir.entry_points.into_iter().map(move |point| (recipe.name, source.clone(), point));
        points.collect::<Vec<_>>()
    });
    let points: Vec<_> = points.collect();
    let show = |(name, source, point): &(&'static str, String, naga::EntryPoint), language: Language| Shown {
        place: format!("{name}::{} in {language}", point.name),
        language,
        stage: point.stage,
        entry: Box::leak(point.name.clone().into_boxed_str()),
        text: shader(source, name, language, Some(&point.name)),
    };
    points.par_iter().flat_map_iter(|point| Language::ALL.into_iter().map(|language| show(point, language))).collect()
});

#[test]
fn recipes_compile_in_every_language_that_can_say_them() {
    let has_tools = has_tools("the recipes in other languages");
    let folder = folder();
    let shown = &*SHOWN;
    let fault = |(index, shown): (usize, &Shown)| match &shown.text {
        // GLSL ES 3.00 has neither; nothing else is missing anywhere.
        Err(TranslateError::Lacks { why, .. })
            if shown.language == Language::GlslEs
                && (why == "compute shaders" || why.starts_with("storage buffers (`")) =>
        {
            None
        }
        Err(error) => Some(format!("{}: {error}", shown.place)),
        Ok(text) => {
            let made_up = ["fake", "_group_", "nagaSamplerHeap"].into_iter().find(|word| text.contains(word));
            let compiles = || {
                let how = As::Shader(shown.stage, shown.entry);
                let is_compiled = has_tools && COMPILED.contains(&shown.language);
                is_compiled.then(|| {
                    compiled(text, shown.language, how, folder.path(), &format!("{}{index}", shown.entry)).err()
                })?
            };
            let fault = made_up.map(|word| format!("`{word}`")).or_else(compiles);
            fault.map(|fault| format!("{}: {fault}", shown.place))
        }
    };
    let faults: Vec<String> = shown.par_iter().enumerate().filter_map(fault).collect();
    assert!(faults.is_empty(), "{} faults, the first:\n{}", faults.len(), faults[..faults.len().min(8)].join("\n"));
    let in_es = shown.iter().filter(|shown| shown.language == Language::GlslEs && shown.text.is_ok()).count();
    assert!(shown.len() > 200 && in_es > 10, "{} of {}", in_es, shown.len());
}

/// The first comment's table of bindings and overrides is what the code says.
#[test]
fn a_recipe_tells_where_its_bindings_are() {
    let mut rows = 0;
    for shown in &*SHOWN {
        let Ok(text) = &shown.text else { continue };
        let code: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        let comment: Vec<&str> =
            text.lines().filter(|line| !line.starts_with('#')).take_while(|line| line.starts_with("//")).collect();
        let has = |name: &str, place: &str| {
            let is_name = |word: &str| word.trim_end_matches('_') == name || word.strip_suffix("_block") == Some(name);
            let is_it = |line: &&str| line.contains(place) && words(line).any(is_name);
            code.iter().any(is_it)
        };
        for place in comment.iter().filter_map(|line| line.strip_prefix("//   @group(")) {
            let (declared, position) = place.rsplit_once(": ").expect("a place");
            let name = declared.split(": ").next().and_then(|text| text.rsplit(' ').next()).expect("a name");
            let is_there = match shown.language {
                Language::Hlsl => {
                    // Space 0 goes without saying.
                    let bare = position.replace(", space0)", ")");
                    has(name, &format!(": {position}")) || has(name, &format!(": {bare}"))
                }
                Language::Msl => has(name, position),
                // GLSL has no samplers of their own.
                _ if declared.contains("sampler") => true,
                Language::Glsl => has(name, &position[position.find("binding = ").expect("a number")..]),
                Language::GlslEs => has(name, "uniform"),
            };
            assert!(is_there, "{}: {declared} at {position}", shown.place);
            rows += 1;
        }
        let count = match shown.language {
            Language::Hlsl => code.iter().filter(|line| line.contains(": register(")).count(),
            Language::Glsl => code.iter().filter(|line| line.contains("binding = ")).count(),
            _ => 0,
        };
        let told =
            comment.iter().filter(|line| line.starts_with("//   @group(") && !line.contains("with its textures"));
        assert!(count <= told.count(), "{}: a binding is not told", shown.place);
        for line in comment.iter().skip_while(|line| !line.contains("by an override")).skip(1) {
            let Some((name, value)) = line.strip_prefix("//   ").and_then(|line| line.split_once(" = ")) else { break };
            let value = value.trim_end_matches(['u', 'i', 'f']);
            assert!(!has(name, "= ") || has(name, &format!("= {value}")), "{}: {line}", shown.place);
        }
        // No vertex is flipped, and no depth stretched.
        assert!(!text.contains("gl_Position.yz ="), "{}", shown.place);
    }
    assert!(rows > 500, "{rows}");
}

/// What is said of bindings and entry points in the WGSL is said in each language.
#[test]
fn a_recipe_keeps_the_comments_of_its_bindings_and_entry_points() {
    for shown in &*SHOWN {
        let Ok(text) = &shown.text else { continue };
        let recipe =
            RECIPES.iter().find(|recipe| shown.place.starts_with(&format!("{}::", recipe.name))).expect("a recipe");
        let source = recipe.compose();
        let lines: Vec<&str> = source.lines().collect();
        for declaration in declarations(&lines) {
            let is_binding = declaration.lines.iter().any(|line| line.starts_with("@group("));
            let Some(name) = declaration.name.filter(|name| is_binding || *name == shown.entry) else { continue };
            let is_told = |line: &str| line.starts_with("//   @group(") && line.contains(&format!(" {name}: "));
            let is_used = name == shown.entry || text.lines().any(is_told);
            let is_sampler = declaration.lines.iter().any(|line| line.contains(": sampler"));
            if !is_used || (is_sampler && shown.language.is_glsl()) {
                continue;
            }
            for line in declaration.comment() {
                let told = line.trim_start_matches("//").trim_start();
                assert!(text.contains(told), "{}: `{name}`: {line}", shown.place);
            }
        }
    }
}

/// A vertex and a fragment shader that are used together agree about bindings and what goes between them.
#[test]
fn stages_of_a_recipe_link() {
    if !has_tools("stages together") {
        return;
    }
    let folder = folder();
    let mut linked = 0;
    let has_stages = |recipe: &&Recipe| {
        let source = recipe.compose();
        source.contains("@vertex") && source.contains("@fragment")
    };
    let (staged, others): (Vec<&Recipe>, Vec<_>) = RECIPES.iter().partition(has_stages);
    for recipe in [staged, others].into_iter().flat_map(|recipes| lapidary_testing::sampled(recipes, 3)) {
        let source = recipe.compose();
        let (ir, _) = dispatch::parse(&source, recipe.name).expect("valid WGSL");
        let in_stage = |stage| ir.entry_points.iter().filter(move |point| point.stage == stage);
        for (vertex, fragment) in
            in_stage(ShaderStage::Vertex).flat_map(|vertex| in_stage(ShaderStage::Fragment).map(move |it| (vertex, it)))
        {
            let mut command = Command::new(TOOLS[0]);
            command.args(["-G", "-l", "--auto-map-locations", "-o"]).arg(folder.path().join("linked.spv"));
            for (point, extension) in [(vertex, "vert"), (fragment, "frag")] {
                let path = folder.path().join(format!("{}.{}.{extension}", recipe.name, point.name));
                let text = shader(&source, recipe.name, Language::Glsl, Some(&point.name)).expect("translated");
                std::fs::write(&path, text).expect("a file");
                command.arg(path);
            }
            assert_eq!(run(&mut command), Ok(()), "{}", recipe.name);
            linked += 1;
        }
        // HLSL holds all entry points, as it is handed out.
        let whole = shader(&source, recipe.name, Language::Hlsl, None).expect("translated");
        for point in &ir.entry_points {
            let entry: &'static str = Box::leak(point.name.clone().into_boxed_str());
            let found = compiled(&whole, Language::Hlsl, As::Shader(point.stage, entry), folder.path(), entry);
            assert_eq!(found, Ok(()), "{}::{entry}", recipe.name);
        }
    }
    assert!(linked > if lapidary_testing::whole() { 15 } else { 0 }, "{linked}");
}

#[test]
#[ignore = "long; .ci/full runs it"]
fn dist_writes_every_text_and_the_same_again() {
    let folder = folder();
    let out = folder.path().join("dist");
    let read = |name: &str| std::fs::read(out.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let written = dist::write(&out).expect("written");
    for module in modules() {
        for path in [format!("wgsl/{}.wgsl", module.name), format!("wesl/shaders/{}.wesl", module.name)] {
            assert_eq!(read(&path), module.source.as_bytes());
        }
        for language in Language::ALL {
            let name = format!("{}/{}.{}", dist::folder_of(language), module.name, language.extension());
            assert_eq!(read(&name), of_module(module, language).as_bytes(), "{name}");
        }
    }
    for recipe in RECIPES {
        for name in ["wgsl/recipes/{}.wgsl", "hlsl/recipes/{}.hlsl", "msl/recipes/{}.metal", "spirv/recipes/{}.spv"] {
            assert!(!read(&name.replace("{}", recipe.name)).is_empty());
        }
    }
    let index = String::from_utf8(read("README.md")).expect("text");
    assert!(
        index.contains("| display | display_vertex, display_fragment |") && index.contains("| refraction |"),
        "{index}"
    );
    let hlsl = read("hlsl/recipes/gem.hlsl");
    assert_eq!(dist::write(&out).expect("written again"), written);
    assert_eq!(read("hlsl/recipes/gem.hlsl"), hlsl);
    std::fs::write(out.join("mine.txt"), "mine").expect("a file");
    let error = dist::write(&out).expect_err("a foreign file").to_string();
    assert!(error.contains("mine.txt") && error.contains("cook dist"), "{error}");
}
