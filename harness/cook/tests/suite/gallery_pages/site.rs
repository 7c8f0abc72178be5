//! The site, built once for all tests of a run, and its pages.

use super::html::{self, Piece};
use crate::program::cook;
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
#[derive(Debug)]
pub(crate) struct SitePage {
    /// Size in bytes.
    pub(crate) bytes: u64,
    pub(crate) pieces: Vec<Piece>,
    /// What its anchors may lead to.
    pub(crate) ids: BTreeSet<String>,
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
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let pieces = html::pieces(&text);
    let ids = pieces.iter().filter_map(|piece| match piece {
        Piece::Start(_, attributes) => attributes.get("id").cloned(),
        _ => None,
    });
    SitePage { bytes: text.len() as u64, ids: ids.collect(), pieces }
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
    /// Returns the values that the page's `select` with this id offers.
    pub(crate) fn options(&self, id: &str) -> Vec<String> {
        let is_it = |piece: &&Piece| matches!(piece, Piece::Start(_, attributes) if attributes.get("id").is_some_and(|of| of == id));
        let within = self.pieces.iter().skip_while(|piece| !is_it(piece));
        let within = within.take_while(|piece| !matches!(piece, Piece::End(name) if name == "select"));
        let value = |piece: &Piece| match piece {
            Piece::Start(name, attributes) if name == "option" => attributes.get("value").cloned(),
            _ => None,
        };
        within.filter_map(value).collect()
    }
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
    let of = |address: &str| resolved(page, address);
    assert_eq!(of("../index.html#top").as_deref(), Some("index.html"));
    assert_eq!(of("veins.html?x").as_deref(), Some("modules/veins.html"));
    assert_eq!(of("#here").as_deref(), Some(page));
    assert_eq!(of("../../etc/passwd").as_deref(), Some("(outside)/../../etc/passwd"));
    assert_eq!(of("/etc/passwd").as_deref(), Some("/etc/passwd"));
    assert_eq!([of("https://example.org/a"), of("data:,")], [None, None]);
}
