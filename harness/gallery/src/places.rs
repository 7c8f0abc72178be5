//! Where everything of the repository that the site shows stands on it.

use super::guides::{ENGINES, GUIDES};
use super::markdown::{Image, Links};
use super::pages::address;
use super::pictures::Shown;
use lapidary_cookbook as cookbook;
use std::collections::BTreeMap;

/// The pages of the repository's files, and the pictures of its pictures.
#[derive(Debug, Default)]
pub struct Places {
    pages: BTreeMap<String, String>,
    pictures: BTreeMap<String, Image>,
}

impl Places {
    /// Places every doc page, module and recipe, and the pictures that are shown.
    pub fn new(shown: &[Shown]) -> Self {
        let mut pages = BTreeMap::new();
        let mut put = |file: String, page: String| pages.insert(file, page);
        for module in cookbook::modules() {
            let page = address("modules", module.name);
            for file in [
                format!("docs/{}.md", module.name),
                format!("wgsl/{}.wgsl", module.name),
                format!("crates/{}", module.name),
                format!("crates/{}/src/lib.rs", module.name),
            ] {
                put(file, page.clone());
            }
        }
        for recipe in lapidary_wgsl::RECIPES {
            let page = address("recipes", recipe.name);
            put(format!("docs/recipes/{}.md", recipe.name), page.clone());
            put(format!("wgsl/recipes/{}.wgsl", recipe.name), page);
        }
        for guide in GUIDES.iter().chain(&ENGINES) {
            put(guide.file.to_owned(), address("guides", guide.name));
        }
        put("README.md".to_owned(), "index.html".to_owned());
        put("snapshots/README.md".to_owned(), "pictures.html".to_owned());
        let pictures = shown.iter().filter_map(|shown| {
            let image = Image {
                file: shown.file.clone(),
                thumb: shown.thumb.clone(),
                width: shown.width,
                height: shown.height,
            };
            Some((shown.source.clone()?, image))
        });
        Self { pages, pictures: pictures.collect() }
    }

    /// Returns the links of a file of the repository, shown on a page in a folder of the site.
    pub fn of<'a>(&'a self, file: &'a str) -> FileLinks<'a> {
        self.of_part(file, "")
    }

    /// Returns the links of a part of a file, whose whole is shown on that page.
    pub fn of_part<'a>(&'a self, file: &'a str, page: &'a str) -> FileLinks<'a> {
        FileLinks { places: self, folder: file.rsplit_once('/').map_or("", |(folder, _)| folder), own: page }
    }
}

/// The links of one file, on a page one folder below the site's root.
#[derive(Debug)]
pub struct FileLinks<'a> {
    places: &'a Places,
    folder: &'a str,
    own: &'a str,
}

impl FileLinks<'_> {
    /// Returns the target's path in the repository.
    fn path(&self, target: &str) -> String {
        let mut parts: Vec<&str> = self.folder.split('/').filter(|part| !part.is_empty()).collect();
        for part in target.split('/') {
            match part {
                "" | "." => {}
                ".." => {
                    parts.pop();
                }
                part => parts.push(part),
            }
        }
        parts.join("/")
    }
}

impl Links for FileLinks<'_> {
    fn page(&self, target: &str) -> Option<String> {
        Some(["../", self.places.pages.get(&self.path(target))?].concat())
    }

    fn own(&self) -> &str {
        self.own
    }

    fn image(&self, target: &str) -> Option<Image> {
        let image = self.places.pictures.get(&self.path(target))?;
        Some(Image { file: ["../", &image.file].concat(), thumb: ["../", &image.thumb].concat(), ..image.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_leads_to_the_page_of_its_file() {
        let places = Places::new(&[]);
        let links = places.of("docs/recipes/gem_walk.md");
        assert_eq!(links.page("../absorption.md").as_deref(), Some("../modules/absorption.html"));
        assert_eq!(links.page("README.md").as_deref(), Some("../guides/recipes.html"));
        assert_eq!(links.page("../../wgsl/recipes/gem_walk.wgsl").as_deref(), Some("../recipes/gem_walk.html"));
        assert_eq!(links.page("../gem.md").as_deref(), Some("../guides/gem.html"));
        assert_eq!(links.page("../../../etc/passwd"), None);
        assert_eq!(links.image("../../snapshots/gem/brilliant.png"), None);
    }
}
