//! The site, built once for all tests of a run, and its pages.

use super::html::{self, Piece};
use lapidary_testing::program::cook;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// Variable with the folder of a site that is built already.
const VARIABLE: &str = "LAPIDARY_GALLERY";

/// A built site.
#[derive(Debug)]
pub(crate) struct Site {
    /// Its folder.
    pub(crate) folder: PathBuf,
    /// Its pages by their paths.
    pub(crate) pages: BTreeMap<String, SitePage>,
}

/// A page of it.
#[derive(Debug, Default)]
pub(crate) struct SitePage {
    /// Size in bytes.
    pub(crate) bytes: u64,
    pub(crate) pieces: Vec<Piece>,
    /// What its anchors may lead to.
    pub(crate) ids: BTreeSet<String>,
    /// The pictures that open large, by the names that `#picture=` has: those of their files, without the ending.
    pub(crate) pictures: BTreeSet<String>,
    /// The rungs that `#compare=` may name, by their ladders.
    pub(crate) ladders: BTreeMap<String, BTreeSet<String>>,
    /// Whether it draws a scene, whose state its address holds.
    pub(crate) is_live: bool,
    /// The names of its controls.
    pub(crate) controls: BTreeSet<String>,
}

/// Returns the site, as `cook gallery` writes it.
pub(crate) fn site() -> &'static Site {
    static SITE: LazyLock<Site> = LazyLock::new(|| {
        let folder = std::env::var_os(VARIABLE).map_or_else(build, PathBuf::from);
        let folder = folder.canonicalize().expect("a folder");
        let paths = files(&folder).into_iter().filter(|path| path.ends_with(".html") && !path.starts_with(APART));
        let pages = paths.map(|path| (path.clone(), page(&folder.join(path)))).collect();
        Site { folder, pages }
    });
    &SITE
}

fn build() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("gallery");
    let answer =
        cook(Path::new(env!("CARGO_MANIFEST_DIR")), &["gallery".as_ref(), "--out".as_ref(), folder.as_os_str()]);
    assert_eq!(answer.code, Some(0), "{}", answer.stderr);
    folder
}

fn page(path: &Path) -> SitePage {
    SitePage::of(&std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())))
}

/// The mirrors' documentation, which is not the site's own.
const APART: &str = "rustdoc/";

/// Returns the paths of all files below a folder, with `/`.
pub(crate) fn files(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![PathBuf::new()];
    while let Some(below) = open.pop() {
        for entry in std::fs::read_dir(folder.join(&below)).expect("a folder") {
            let entry = entry.expect("an entry");
            let path = below.join(entry.file_name());
            if entry.file_type().expect("a kind").is_dir() {
                open.push(path);
            } else {
                found.push(path.to_str().expect("UTF-8").replace('\\', "/"));
            }
        }
    }
    found.sort();
    found
}

impl Site {
    /// Returns the size of one of its files; 0 if it is not there, which another test finds.
    pub(crate) fn bytes(&self, path: &str) -> u64 {
        std::fs::metadata(self.folder.join(path)).map_or(0, |data| data.len())
    }

    /// Returns the size of all its files but the mirrors' documentation.
    pub(crate) fn all_bytes(&self) -> u64 {
        files(&self.folder).iter().filter(|path| !path.starts_with(APART)).map(|path| self.bytes(path)).sum()
    }

    /// Returns a page's address.
    pub(crate) fn address(&self, path: &str) -> String {
        format!("file://{}/{path}", self.folder.display())
    }

    /// Returns the first page of a folder.
    pub(crate) fn first(&self, folder: &str) -> &str {
        self.pages.keys().find(|path| path.starts_with(folder)).unwrap_or_else(|| panic!("no page in {folder}"))
    }
}

impl SitePage {
    /// Reads a page.
    pub(crate) fn of(text: &str) -> Self {
        let pieces = html::pieces(text);
        let mut page = Self { bytes: text.len() as u64, ..Self::default() };
        let (mut ladder, mut is_side) = (None, false);
        for piece in &pieces {
            let Piece::Start(name, attributes) = piece else { continue };
            page.ids.extend(attributes.get("id").cloned());
            page.is_live |= piece.has_class("live");
            match name.as_str() {
                "a" if piece.has_class("picture") => page.pictures.extend(attributes.get("href").map(|to| stem(to))),
                "figure" => ladder = attributes.get("data-ladder").filter(|_| piece.has_class("compare")),
                "select" | "input" => {
                    is_side = attributes.contains_key("data-side");
                    page.controls.extend(attributes.get("name").cloned());
                }
                "option" if is_side => {
                    if let (Some(ladder), Some(rung)) = (ladder, attributes.get("value")) {
                        page.ladders.entry(ladder.clone()).or_default().insert(rung.clone());
                    }
                }
                _ => {}
            }
        }
        page.pieces = pieces;
        page
    }

    /// Returns the values that the page's `select` with this id offers.
    pub(crate) fn options(&self, id: &str) -> Vec<String> {
        let is_it = |piece: &&Piece| matches!(piece, Piece::Start(_, attributes) if attributes.get("id").is_some_and(|found| found == id));
        let within = self.pieces.iter().skip_while(|piece| !is_it(piece));
        let within = within.take_while(|piece| !matches!(piece, Piece::End(name) if name == "select"));
        let value = |piece: &Piece| match piece {
            Piece::Start(name, attributes) if name == "option" => attributes.get("value").cloned(),
            _ => None,
        };
        within.filter_map(value).collect()
    }
}

/// Returns the name of an address's file without its ending, as compare.js names pictures.
fn stem(address: &str) -> String {
    let file = address.rsplit('/').next().unwrap_or_default();
    decoded(file.rsplit_once('.').map_or(file, |(stem, _)| stem))
}

/// Returns a part of an address, its bytes after `%` replaced.
pub(crate) fn decoded(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        let digits = after.get(..2).filter(|_| *first == b'%').and_then(|digits| std::str::from_utf8(digits).ok());
        let escaped = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        bytes.push(escaped.unwrap_or(*first));
        rest = if escaped.is_some() { &after[2..] } else { after };
    }
    String::from_utf8(bytes).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// Returns the path that a relative address leads to, from a page's path; nothing for an address with a scheme.
pub(crate) fn resolved(page: &str, address: &str) -> Option<String> {
    let path = address.split(['#', '?']).next().unwrap_or_default();
    if address.split('/').next().unwrap_or_default().contains(':') {
        return None;
    }
    if path.is_empty() {
        return Some(page.to_owned());
    }
    // Nothing on the site starts at a server's root.
    let mut parts: Vec<&str> = if path.starts_with('/') { vec!["(root)"] } else { page.split('/').collect() };
    parts.pop();
    for part in path.split('/') {
        match part {
            "." => {}
            // One too many leaves the site.
            ".." if parts.pop().is_none() => return Some(format!("(outside)/{path}")),
            ".." => {}
            part => parts.push(part),
        }
    }
    Some(parts.join("/"))
}

#[test]
fn addresses_are_resolved() {
    let page = "modules/srgb.html";
    let target_of = |address: &str| resolved(page, address);
    assert_eq!(target_of("../index.html#top").as_deref(), Some("index.html"));
    assert_eq!(target_of("veins.html?x").as_deref(), Some("modules/veins.html"));
    assert_eq!(target_of("#here").as_deref(), Some(page));
    assert_eq!(target_of("../../etc/passwd").as_deref(), Some("(outside)/../../etc/passwd"));
    assert_eq!(target_of("/etc/passwd").as_deref(), Some("/etc/passwd"));
    assert_eq!([target_of("https://example.org/a"), target_of("data:,")], [None, None]);
    assert_eq!(["walk-8%2Btracker", "100%", "%C3%A9", "a%2"].map(decoded), ["walk-8+tracker", "100%", "é", "a%2"]);
    assert_eq!(["../images/a.b.jpg", "a%20b.png", "a"].map(stem), ["a.b", "a b", "a"]);
}
