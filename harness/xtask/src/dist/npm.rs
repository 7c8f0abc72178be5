//! An npm package: the modules and recipes as strings, with types, and what runs a frame.

use super::error::DistError;
use super::whole::Whole;
use lapidary_cookbook::modules;
use lapidary_specialise::layout::StructLayout;
use lapidary_translate::{Bound, Language, bindings, library};
use naga::TypeInner;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Name of the package.
pub const NAME: &str = "lapidary-shaders";

/// Returns the package's files.
///
/// # Errors
/// Returns an error if a text cannot be translated.
pub fn files(recipes: &[Whole]) -> Result<Vec<(String, Vec<u8>)>, DistError> {
    let mut files = vec![
        ("package.json".to_owned(), PACKAGE.replace("VERSION", env!("CARGO_PKG_VERSION")).replace("NAME", NAME)),
        ("README.md".to_owned(), README.to_owned()),
        ("frame.js".to_owned(), include_str!("../../../../docs/engines/frame.js").to_owned()),
        ("frame.d.ts".to_owned(), FRAME_TYPES.to_owned()),
    ];
    let mut index = [String::new(), String::new()];
    for module in modules() {
        let name = module.name;
        let texts = [("wgsl", module.source.to_owned()), ("glsl-es", library(module.source, name, Language::GlslEs)?)];
        for ((folder, source), index) in texts.into_iter().zip(&mut index) {
            files.push((format!("{folder}/{name}.js"), constant(&source)));
            files.push((format!("{folder}/{name}.d.ts"), TEXT_TYPES.to_owned()));
            index.push_str(&format!("export {{ default as {name} }} from './{name}.js';\n"));
        }
    }
    for (folder, index) in ["wgsl", "glsl-es"].into_iter().zip(index) {
        files.push((format!("{folder}/index.js"), index.clone()));
        files.push((format!("{folder}/index.d.ts"), index));
    }
    for whole in recipes {
        let [code, types] = recipe_module(whole);
        files.push((format!("recipes/{}.js", whole.recipe.name), code));
        files.push((format!("recipes/{}.d.ts", whole.recipe.name), types));
    }
    Ok(files.into_iter().map(|(name, text)| (name, text.into_bytes())).collect())
}

/// Returns a module of JavaScript whose default is a text.
fn constant(source: &str) -> String {
    format!("export default {};\n", Value::from(source))
}

/// Returns a module of JavaScript with a recipe, its entry points, overrides, bindings and layouts, and its types, in
/// which the layouts are literal.
fn recipe_module(Whole { source, ir, glsl_es, .. }: &Whole) -> [String; 2] {
    let stages: BTreeMap<&str, &str> = ir
        .entry_points
        .iter()
        .map(|point| {
            let stage = match point.stage {
                naga::ShaderStage::Vertex => "vertex",
                naga::ShaderStage::Compute => "compute",
                _ => "fragment",
            };
            (point.name.as_str(), stage)
        })
        .collect();
    let overrides: Vec<&str> = ir.overrides.iter().filter_map(|(_, it)| it.name.as_deref()).collect();
    let row = |bound: Bound| {
        let ty = &ir.types[bound.ty];
        let structure = match ty.inner {
            TypeInner::Array { base, .. } => ir.types[base].name.as_deref(),
            _ => ty.name.as_deref(),
        };
        json!({
            "group": bound.group,
            "binding": bound.binding,
            "name": bound.name,
            "kind": bound.kind.name(),
            "struct": structure,
        })
    };
    let bindings: Vec<Value> = bindings(ir).into_iter().map(row).collect();
    let used: Vec<&str> = bindings.iter().filter_map(|row| row["struct"].as_str()).collect();
    let layouts: BTreeMap<&str, Value> = StructLayout::all(ir)
        .filter(|(name, _)| used.contains(name))
        .map(|(name, layout)| {
            let fields = layout.fields.iter().map(|field| {
                let offset = field.offsets.first().copied().unwrap_or_default();
                json!({ "name": field.name, "type": field.ty, "offset": offset })
            });
            let fields: Vec<Value> = fields.collect();
            (name, json!({ "size": layout.size, "fields": fields }))
        })
        .collect();
    let layouts = json!(layouts);
    let glsl_es: BTreeMap<&str, &str> =
        glsl_es.iter().map(|(entry, _, text)| (entry.as_str(), text.as_str())).collect();
    let code = format!(
        "export const wgsl = {};\nexport const glslEs = {:#};\nexport const entryPoints = {:#};\nexport const overrides = {:#};\nexport const bindings = {:#};\nexport const layouts = {layouts:#};\n",
        Value::from(source.as_str()),
        json!(glsl_es),
        json!(stages),
        json!(overrides),
        json!(bindings),
    );
    [code, format!("{RECIPE_TYPES}export const layouts: {layouts:#};\n")]
}

const TEXT_TYPES: &str = "declare const text: string;\nexport default text;\n";

const RECIPE_TYPES: &str = "\
/** A whole shader; its overrides named EFFECT_… switch effects on and off. */
export const wgsl: string;
/** The entry points that GLSL ES 3.00 can say, each a whole shader; those that need storage buffers or compute are
 *  not among them. */
export const glslEs: Record<string, string>;
/** The stage of each entry point. */
export const entryPoints: Record<string, 'vertex' | 'fragment' | 'compute'>;
/** Names for a pipeline's `constants`. */
export const overrides: string[];
export interface Binding {
  group: number;
  binding: number;
  name: string;
  kind: 'uniform' | 'storage' | 'read-only-storage' | 'sampler' | 'texture' | 'storage-texture';
  /** The struct that the buffer holds, or holds an array of; null if there is none. */
  struct: string | null;
}
export const bindings: Binding[];
/** Structs in `bindings` of 32-bit numbers alone: bytes of one, and its fields in order, each with its type in WGSL
 *  and its offset in bytes. A field of an inner struct is named `outer.inner`. */
";

const PACKAGE: &str = r#"{
  "name": "NAME",
  "version": "VERSION",
  "description": "WGSL and GLSL ES for gems and translucent materials, tested against mirrors and oracles",
  "license": "(MIT-0 OR Apache-2.0)",
  "type": "module",
  "sideEffects": false,
  "keywords": ["wgsl", "webgpu", "webgl", "glsl", "shader", "refraction", "dispersion", "translucency"],
  "exports": {
    "./wgsl": { "types": "./wgsl/index.d.ts", "default": "./wgsl/index.js" },
    "./wgsl/*": { "types": "./wgsl/*.d.ts", "default": "./wgsl/*.js" },
    "./glsl-es": { "types": "./glsl-es/index.d.ts", "default": "./glsl-es/index.js" },
    "./glsl-es/*": { "types": "./glsl-es/*.d.ts", "default": "./glsl-es/*.js" },
    "./recipes/*": { "types": "./recipes/*.d.ts", "default": "./recipes/*.js" },
    "./frame": { "types": "./frame.d.ts", "default": "./frame.js" },
    "./package.json": "./package.json"
  }
}
"#;

const FRAME_TYPES: &str = "\
export interface Picture {
  width: number;
  height: number;
  texels: Float32Array | Uint8Array;
}
export interface Pass {
  kind: 'render' | 'compute' | 'clear' | 'copy' | 'read';
  name?: string;
}
/** Runs what `cook frame` writes. `GPUDevice` is a type of @webgpu/types. */
export class Frame {
  /** Makes everything that the frame in a folder needs; nothing is drawn yet. */
  static load(device: GPUDevice, folder: string): Promise<Frame>;
  /** Runs all passes, and returns the pictures by name. */
  run(): Promise<Record<string, Picture>>;
  /** Submits the passes that a test selects, by default all that do not read back. */
  draw(selects?: (pass: Pass) => boolean): void;
  /** The buffers of a name that hold a struct. */
  buffers(name: string): number[];
  /** The initial value of a field of a buffer. */
  field(place: number, name: string): Float32Array;
  /** Writes a field of a buffer. */
  write(place: number, name: string, floats: ArrayLike<number>): void;
  /** Frees what the frame holds on the device. */
  destroy(): void;
}
";

const README: &str = "\
# lapidary-shaders

Shaders for gems and translucent materials, as text: each technique is functions without bindings, in WGSL and in
GLSL ES 3.00, with its units, domain and accuracy in its comments; each recipe a whole WGSL shader.

```js
import refraction from 'lapidary-shaders/wgsl/refraction';      // one module
import { fresnel, absorption } from 'lapidary-shaders/glsl-es'; // several
import { wgsl, bindings, layouts } from 'lapidary-shaders/recipes/gem_walk';
import { Frame } from 'lapidary-shaders/frame';                  // runs what `cook frame` writes

const module = device.createShaderModule({ code: `${refraction}\n${shaderOfMyOwn}` });
```

Modules can stand in one text in any order. `layouts` has the offset of each field of a recipe's structs.

Licence: MIT-0 or Apache-2.0, at your choice.
";
