//! Releases of the modules: identifies a pasted copy by its tokens, and lists the fixes since then.
//!
//! `wgsl/releases/<release>.json` holds a hash of each function with the structs and consts that it
//! uses, and a hash of each module's text, which the module's own `// Version:` line repeats.
//! `CHANGELOG.md` lists the changes by function.

use lapidary_assay::tokens::{Item, items, tokens};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

/// Number of the current or upcoming release.
pub const CURRENT: &str = env!("CARGO_PKG_VERSION");
/// Changes from release to release, by function.
const CHANGELOG: &str = include_str!("../../../../CHANGELOG.md");
/// Prefix of the header line that holds release and hash.
const TAG: &str = "// Version: ";

/// Hashes of a release, as stored in `wgsl/releases/`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Release {
    /// Release number.
    pub release: String,
    /// Modules by name.
    pub modules: BTreeMap<String, Hashes>,
}

/// Hashes of a module in one release.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hashes {
    /// Hash of the text without the `// Version:` line.
    pub text: String,
    /// Hash of each function with the structs and consts that it uses, by tokens: comments and
    /// white space are ignored. Functions that it calls have their own hashes.
    pub functions: BTreeMap<String, String>,
}

impl Hashes {
    /// Computes the hashes of a text of the module `name`, for the functions that carry the
    /// module's prefix.
    pub fn of(name: &str, source: &str) -> Hashes {
        let code = tokens(source);
        // Only the module's own: in a larger file, other names may coincide with locals here.
        let own: Vec<Item<'_>> = items(&code).into_iter().filter(|item| belongs(name, item.name)).collect();
        let functions = own.iter().filter(|item| item.kind == "fn");
        let functions = functions.map(|function| (function.name.to_owned(), function_hash(&own, function))).collect();
        Hashes { text: text_hash(source), functions }
    }
}

/// Whether a name starts with the module's name, in the style of functions, structs or consts.
fn belongs(module: &str, name: &str) -> bool {
    lapidary_wgsl::prefixes(module).iter().any(|prefix| name.starts_with(prefix))
}

/// Hash of a function's tokens, then of those of the structs and consts that it uses, sorted by
/// name.
fn function_hash(own: &[Item<'_>], function: &Item<'_>) -> String {
    let mut reached = BTreeSet::from([function.name]);
    let mut ahead = vec![function];
    while let Some(item) = ahead.pop() {
        let named: BTreeSet<&str> = item.tokens.iter().map(|token| token.text).collect();
        for other in own.iter().filter(|other| other.kind != "fn" && named.contains(other.name)) {
            if reached.insert(other.name) {
                ahead.push(other);
            }
        }
    }
    let mut hash = Fnv::default();
    let others = reached.iter().filter(|name| **name != function.name);
    for name in std::iter::once(&function.name).chain(others) {
        for item in own.iter().filter(|item| item.name == *name) {
            item.tokens.iter().for_each(|token| hash.add(token.text));
        }
    }
    hash.hex()
}

/// Hash of a module's text without its `// Version:` line; line endings are ignored.
pub fn text_hash(source: &str) -> String {
    let mut hash = Fnv::default();
    source.lines().filter(|line| !line.starts_with(TAG)).for_each(|line| hash.add(line));
    hash.hex()
}

/// 64-bit hash of Fowler, Noll and Vo (FNV-1a), each text terminated by a zero byte. It
/// distinguishes texts that were not made to collide.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn add(&mut self, text: &str) {
        for byte in text.bytes().chain([0]) {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn hex(&self) -> String {
        format!("{:016x}", self.0)
    }
}

/// Release and hash from the first `// Version:` line of a text; `None` if there is no such line.
pub fn stated(source: &str) -> Option<(&str, &str)> {
    let line = source.lines().find_map(|line| line.strip_prefix(TAG))?;
    line.trim_end().split_once(", hash ")
}

/// Returns a module's text with the line that states its release and hash, in place of an earlier
/// one or after the licence.
pub fn with_version(source: &str) -> String {
    let version = format!("{TAG}{CURRENT}, hash {}", text_hash(source));
    let mut lines: Vec<&str> = source.lines().filter(|line| !line.starts_with(TAG)).collect();
    let after =
        lines.iter().position(|line| line.starts_with("// SPDX-License-Identifier:")).map_or(1, |line| line + 1);
    lines.insert(after.min(lines.len()), &version);
    lines.join("\n") + "\n"
}

/// Releases and the changes between them.
#[derive(Clone, Debug)]
pub struct History {
    /// Releases, oldest first; the last is the current one.
    pub releases: Vec<Release>,
    /// Entries of the changelog that name functions.
    pub changes: Vec<Change>,
}

impl History {
    /// Returns the cookbook's own history.
    ///
    /// # Panics
    /// If a table in `wgsl/releases/` is damaged, which a test rules out.
    pub fn of_cookbook() -> &'static History {
        static HISTORY: OnceLock<History> = OnceLock::new();
        HISTORY.get_or_init(|| {
            let read =
                |text: &&str| serde_json::from_str(text).unwrap_or_else(|error| panic!("wgsl/releases: {error}"));
            let releases = lapidary_wgsl::RELEASES.iter().map(read).collect();
            History { releases, changes: parse_changes(CHANGELOG) }
        })
    }

    /// Compares those `functions` of the module `name` that occur in `text` with the releases.
    pub fn standing(&self, name: &str, functions: &[&str], text: &str) -> Standing {
        let found = Hashes::of(name, text);
        // If several modules are pasted together, take the first version line below this module's
        // heading.
        let start = text.find(&format!("// {name}: "));
        let stated = start.and_then(|start| stated(&text[start..])).map(|(release, _)| release.to_owned());
        let origin = |function: &&str| {
            let hash = found.functions.get(*function)?;
            let holds = |release: &&Release| {
                release.modules.get(name).is_some_and(|hashes| hashes.functions.get(*function) == Some(hash))
            };
            let holding: Vec<String> =
                self.releases.iter().filter(holds).map(|release| release.release.clone()).collect();
            // Among releases with the same text, take the one that the header states, or else the
            // oldest.
            let since = holding.iter().find(|release| stated.as_ref() == Some(*release)).or(holding.first()).cloned();
            let changes = since.as_deref().map_or_else(Vec::new, |since| self.changes_since(function, since));
            Some(Origin { function: (*function).to_owned(), since, release: holding.last().cloned(), changes })
        };
        Standing {
            module: name.to_owned(),
            origins: functions.iter().filter_map(origin).collect(),
            lacking: functions
                .iter()
                .filter(|function| !found.functions.contains_key(**function))
                .map(|function| format!("`{function}`"))
                .collect(),
            stated,
            oldest: None,
            current: self.releases.last().map(|release| release.release.clone()).unwrap_or_default(),
        }
        .with_oldest(self)
    }

    /// Changes to a function after a release, oldest first.
    fn changes_since(&self, function: &str, release: &str) -> Vec<String> {
        let from = self.position(release);
        let concerns = |change: &&Change| {
            change.functions.iter().any(|name| name == function) && self.position(&change.release) > from
        };
        let mut found: Vec<&Change> = self.changes.iter().filter(concerns).collect();
        found.sort_by_key(|change| self.position(&change.release));
        found.into_iter().map(|change| format!("{}: {}", change.release, change.text)).collect()
    }

    fn position(&self, release: &str) -> Option<usize> {
        self.releases.iter().position(|known| known.release == release)
    }
}

/// An entry of `CHANGELOG.md` that names functions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// Release that introduced the change.
    pub release: String,
    /// Names of the functions.
    pub functions: Vec<String>,
    /// What changed and why.
    pub text: String,
}

/// Parses entries such as "- `one`, `two`: text", which may continue on indented lines, below
/// headings such as "## 0.2.0 (unreleased)".
pub fn parse_changes(changelog: &str) -> Vec<Change> {
    let mut changes: Vec<Change> = Vec::new();
    let mut release = "";
    let mut open = false;
    for line in changelog.lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            release = heading.split([' ', ',']).next().unwrap_or_default();
            open = false;
        } else if let Some(entry) = line.strip_prefix("- ") {
            let entry = entry.strip_prefix('`').and_then(|_| entry.split_once(": "));
            open = entry.is_some();
            changes.extend(entry.map(|(names, text)| Change {
                release: release.to_owned(),
                functions: names.split(", ").map(|name| name.trim_matches('`').to_owned()).collect(),
                text: text.to_owned(),
            }));
        } else if let (true, Some(more), Some(last)) = (open, line.strip_prefix("  "), changes.last_mut()) {
            last.text.push(' ');
            last.text.push_str(more.trim());
        } else {
            open = false;
        }
    }
    changes
}

/// Origin of a function in a user's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Name of the function.
    pub function: String,
    /// Newest release that contains this version of the function; `None` if no release does.
    pub release: Option<String>,
    /// Release that it may have been copied from, among those with the same text: the one that the
    /// file states, or the oldest.
    pub since: Option<String>,
    /// Changes since then, oldest first; if the text is the same, changes to what it promises or
    /// calls.
    pub changes: Vec<String>,
}

/// Origins of the functions of one module in a user's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Standing {
    /// Name of the module.
    pub module: String,
    /// Functions in the file, in the module's order.
    pub origins: Vec<Origin>,
    /// Functions of the module that the file lacks, in backticks.
    pub lacking: Vec<String>,
    /// Release stated by its `// Version:` line in the file; `None` if there is no such line.
    pub stated: Option<String>,
    /// Oldest release of an outdated function; `None` if all functions are of the current release
    /// or of none.
    pub oldest: Option<String>,
    /// Current release.
    pub current: String,
}

impl Standing {
    fn with_oldest(mut self, history: &History) -> Standing {
        let old = self.origins.iter().filter_map(|origin| origin.release.as_ref());
        let old = old.filter(|release| **release != self.current);
        self.oldest = old.min_by_key(|release| history.position(release)).cloned();
        self
    }

    /// Describes the origin in a few lines: the release, the changes since, and the functions of no
    /// release.
    pub fn describe(&self) -> String {
        let Standing { module, current, .. } = self;
        let own: Vec<String> = self
            .origins
            .iter()
            .filter(|origin| origin.release.is_none())
            .map(|origin| format!("`{}`", origin.function))
            .collect();
        let mut text = match &self.oldest {
            Some(oldest) => format!("this is {module} of release {oldest}; the cookbook's is {current}"),
            None if own.is_empty() && !self.lacking.is_empty() => {
                format!("this is a part of {module} of release {current}; missing: {}", self.lacking.join(", "))
            }
            None if own.is_empty() => format!("this is {module} of release {current}, the cookbook's own"),
            None if own.len() == self.origins.len() => {
                format!("this is a changed {module}: no release has these functions")
            }
            None => format!("this is {module} of release {current} with changes"),
        };
        let is_old = |origin: &&Origin| origin.release.as_ref().is_some_and(|release| release != current);
        for origin in self.origins.iter().filter(is_old) {
            let what = if origin.changes.is_empty() { "see CHANGELOG.md".to_owned() } else { origin.changes.join(" ") };
            text.push_str(&format!("\n  mended since: `{}` ({what})", origin.function));
        }
        let is_same = |origin: &&Origin| origin.release.as_ref() == Some(current) && !origin.changes.is_empty();
        for Origin { function, since, changes, .. } in self.origins.iter().filter(is_same) {
            let since = since.as_deref().unwrap_or(current);
            text.push_str(&format!(
                "\n  of the same text since {since}, while what it promises or calls was changed: `{function}` ({})",
                changes.join(" ")
            ));
        }
        if !own.is_empty() && own.len() < self.origins.len() {
            text.push_str(&format!("\n  changed from every release: {}", own.join(", ")));
        }
        if let Some(stated) = self.stated.as_ref().filter(|_| !own.is_empty()) {
            text.push_str(&format!("\n  its header says {stated}: it was changed after it was copied"));
        }
        text
    }
}
