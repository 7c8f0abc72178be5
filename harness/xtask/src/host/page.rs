//! The pages as Markdown.

use super::frames::{Listed, Use};
use super::recipe::{Description, Row};
use super::sizes::{self, Rule};
use lapidary_translate::BindingKind;
use std::fmt::Write as _;

/// Says below each title where the page comes from.
const ORIGIN: &str = "<!-- Generated from the recipe and from frames: ./cook test --refresh -->";

/// Returns a cell's text: bars and line ends would end it.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

fn table(page: &mut String, heads: &[&str], rows: impl IntoIterator<Item = Vec<String>>) {
    let _ = writeln!(page, "| {} |", heads.join(" | "));
    let _ = writeln!(page, "|{}", "---|".repeat(heads.len()));
    for row in rows {
        let cells: Vec<String> = row.iter().map(|text| cell(text)).collect();
        let _ = writeln!(page, "| {} |", cells.join(" | "));
    }
    page.push('\n');
}

/// What bindings hold that many recipes have, where the recipe says nothing of its own.
const USUAL: &[(&str, &str)] = &[
    ("view", "The camera, or what a light sees."),
    ("positions", "Three floats for each vertex."),
    ("normals", "Three floats for each vertex, of unit length."),
    ("indices", "Three for each triangle, counter-clockwise from outside."),
    ("uvs", "Two floats for each vertex."),
    ("lights", "All lights; one black light if there is none."),
    ("bodies", "The other bodies."),
    ("environment_map", "An image in latitude and longitude; row 0 is the zenith."),
];

/// Returns what a binding holds.
fn comment(row: &Row) -> String {
    let usual = USUAL.iter().find(|(name, _)| *name == row.name).filter(|_| row.comment.is_empty());
    usual.map_or_else(|| row.comment.clone(), |(_, comment)| (*comment).to_owned())
}

/// Returns a text with a capital at its start.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Returns a binding's size in bytes, or a texture's in words.
fn size(recipe: &str, row: &Row) -> String {
    match (row.bytes, row.is_open, sizes::rule(recipe, &row.name)) {
        (Some(bytes), false, _) => bytes.to_string(),
        (Some(_), true, Some(Rule::Bytes(text, _))) => text.to_owned(),
        (Some(bytes), true, Some(Rule::Each(what))) => format!("{bytes} × {what}"),
        (None, _, Some(Rule::Texture(what))) if row.effects.is_empty() => what.to_owned(),
        (None, _, Some(Rule::Texture(what))) => format!("{what}; 1 × 1 where the effect is off"),
        (None, ..) if row.kind == BindingKind::Sampler => String::new(),
        _ => "–".to_owned(),
    }
}

/// Returns a recipe's page.
pub(super) fn of(described: &Description, uses: &[&Use]) -> String {
    let name = described.name;
    let mut page = format!("# {name}: what a host binds and runs\n\n{ORIGIN}\n\n{}\n\n", sentence(&described.purpose));
    if !described.text.is_empty() {
        let _ = writeln!(page, "{}\n", described.text);
    }
    let modules: Vec<String> = described.requires.iter().map(|module| format!("[{module}](../{module}.md)")).collect();
    if !modules.is_empty() {
        let _ = writeln!(page, "Modules: {}.\n", modules.join(", "));
    }
    let _ = writeln!(
        page,
        "[The WGSL](../../wgsl/recipes/{name}.wgsl); whole: `./cook copy {name}`. [All recipes](README.md).\n"
    );

    page.push_str("## Entry points\n\n");
    table(
        &mut page,
        &["entry point", "stage", "needs", "what it does"],
        described.entries.iter().map(|entry| {
            vec![format!("`{}`", entry.name), entry.stage.to_owned(), entry.needs.clone(), entry.comment.clone()]
        }),
    );

    page.push_str("## Bindings\n\n");
    table(
        &mut page,
        &["group, binding", "name", "kind", "type", "bytes or texels", "effects", "what it holds"],
        described.bindings.iter().map(|row| {
            vec![
                format!("{}, {}", row.group, row.binding),
                format!("`{}`", row.name),
                row.kind.name().to_owned(),
                format!("`{}`", row.ty),
                size(name, row),
                row.effects.clone(),
                comment(row),
            ]
        }),
    );

    if !described.structs.is_empty() {
        page.push_str("## Layouts\n\n");
    }
    for structure in &described.structs {
        let _ = writeln!(page, "### {}, {} bytes\n", structure.name, structure.bytes);
        table(
            &mut page,
            &["offset", "member", "type", "what it is"],
            structure.members.iter().map(|member| {
                vec![
                    member.offset.to_string(),
                    format!("`{}`", member.name),
                    format!("`{}`", member.ty),
                    member.comment.clone(),
                ]
            }),
        );
    }

    if !described.overrides.is_empty() {
        page.push_str("## Overrides\n\n");
        table(
            &mut page,
            &["override", "type", "default", "what it does"],
            described.overrides.iter().map(|item| {
                vec![format!("`{}`", item.name), item.ty.clone(), format!("`{}`", item.default), item.comment.clone()]
            }),
        );
    }

    page.push_str("## Passes\n\n");
    if uses.is_empty() {
        page.push_str("No frame runs it: it is run before a frame is made, or by a host of its own.\n");
        return page;
    }
    table(
        &mut page,
        &["pass", "entry points", "vertices or workgroups", "state", "`./cook frame`"],
        uses.iter().map(|used| {
            let entries: Vec<String> = used.entries.iter().map(|entry| format!("`{entry}`")).collect();
            vec![
                used.pass.clone(),
                entries.join(", "),
                used.count.clone(),
                used.state.clone(),
                format!("`{}`", used.example),
            ]
        }),
    );
    page.trim_end().to_owned() + "\n"
}

/// Returns a recipe's row in the table of all.
pub(super) fn row(described: &Description, uses: &[&Use]) -> Vec<String> {
    let mut passes: Vec<&str> = uses.iter().map(|used| used.pass.as_str()).collect();
    passes.dedup();
    vec![format!("[{0}]({0}.md)", described.name), sentence(&described.purpose), passes.join(", ")]
}

/// Returns the page of all recipes.
pub(super) fn index(rows: Vec<Vec<String>>, frames: &[Listed]) -> String {
    let mut page = format!("# Recipes, for a host\n\n{ORIGIN}\n\n{INTRODUCTION}");
    table(&mut page, &["recipe", "what it draws or computes", "passes"], rows);
    page.push_str(FRAMES);
    for (command, steps) in frames {
        let _ = writeln!(page, "### `./cook frame {command} --out frame`\n");
        table(
            &mut page,
            &["pass", "recipe", "entry points, or buffers", "vertices or workgroups", "times"],
            steps.iter().map(|step| {
                let recipe = if step.recipe.is_empty() { String::new() } else { format!("[{0}]({0}.md)", step.recipe) };
                vec![step.pass.clone(), recipe, step.entries.clone(), step.count.clone(), step.times.to_string()]
            }),
        );
    }
    page.trim_end().to_owned() + "\n"
}

const INTRODUCTION: &str = "\
Each page lists what an engine has to bind and to run: entry points, bindings with sizes and the effects that
bring them, struct layouts with offsets, overrides, passes. Names, types, offsets, comments and passes are read
from the recipe's text and from frames that the renderer makes. `./cook test host` compares the pages with both,
and each formula with the sizes in those frames. Numbers that data decide, such as facets, nodes or words, are
only seen to be whole; textures, and buffers that no frame binds, are said in words.

In formulas, `n` is the number of cells along each edge of a body's grid, or of a level of it; `triangles`,
`vertices` and `halo` (triangles beside the charts of an atlas) are those of the body; `texels` is the side of a
light's map, and `views` the number of such maps. A buffer that is bound as a uniform or holds one struct has
the struct's size.

No recipe has vertex or index buffers: vertices are read from storage buffers. All draw triangle lists with
counter-clockwise fronts. Clip space is WebGPU's: y up, depth from 0 to 1.

";

const FRAMES: &str = "\
## Frames

The passes of some frames, in order, without the last, which read the picture back. The same entry points one
after the other, for several objects or views of lights, stand once. Rows of one pass that are run more than
once are run in turn: the first, the second, then the first again. Indirect numbers of workgroups are in the
buffer `workgroups`, which a pass before has written.

";
