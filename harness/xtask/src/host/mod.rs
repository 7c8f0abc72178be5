//! What a host has to know to run a recipe: entry points, bindings with their layouts, overrides, and, from frames
//! that the renderer makes, passes and sizes. `docs/recipes/` holds a page for each recipe.

mod error;
mod frames;
mod page;
mod recipe;
mod sizes;

pub use error::HostError;

use lapidary_cookbook::marks;
use lapidary_wgsl::RECIPES;

/// Returns what each recipe's text says.
fn described() -> Result<Vec<recipe::Description>, HostError> {
    let mut all = Vec::new();
    for recipe in RECIPES {
        let failed = |message: String| HostError::Recipe { recipe: recipe.name, message };
        let source = marks::without(recipe, &[]).map_err(|fault| failed(fault.message))?;
        all.push(recipe::Description::of(recipe, &source).map_err(failed)?);
    }
    Ok(all)
}

/// Returns the pages: the names of files in `docs/recipes/` with their texts.
///
/// # Errors
/// Returns an error if a recipe is not sound, or if a frame holds a size that no formula gives.
pub fn pages() -> Result<Vec<(String, String)>, HostError> {
    let all = described()?;
    let (uses, frames) = frames::all(&all)?;
    let uses_of = |name: &str| uses.iter().filter(|used| used.recipe == name).collect::<Vec<_>>();
    let rows = all.iter().map(|described| page::row(described, &uses_of(described.name))).collect();
    let pages = all.iter().map(|recipe| (format!("{}.md", recipe.name), page::of(recipe, &uses_of(recipe.name))));
    Ok(std::iter::once(("README.md".to_owned(), page::index(rows, &frames))).chain(pages).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row that is left when a binding goes would never be checked again.
    #[test]
    fn every_formula_is_of_something_that_there_is() {
        let all = described().unwrap_or_else(|error| panic!("{error}"));
        for (names, start, _) in sizes::SIZES {
            for name in *names {
                let mut rows =
                    all.iter().filter(|recipe| recipe.name.starts_with(start)).flat_map(|recipe| &recipe.bindings);
                assert!(rows.any(|row| row.name == *name), "`{name}` of `{start}`");
            }
        }
        for (name, _) in sizes::WORKGROUPS {
            assert!(all.iter().flat_map(|recipe| &recipe.entries).any(|entry| entry.name == *name), "`{name}`");
        }
    }

    /// With another scene's numbers no frame's sizes would fit: here a formula of another binding.
    #[test]
    fn a_wrong_formula_is_found() {
        let mut all = described().unwrap_or_else(|error| panic!("{error}"));
        let row =
            all.iter_mut().flat_map(|recipe| &mut recipe.bindings).find(|row| row.name == "positions").expect("a row");
        row.name = "indices".to_owned();
        let error = frames::all(&all).map(|_| ()).expect_err("positions are no indices").to_string();
        assert!(error.contains("12 × triangles"), "{error}");
    }
}
