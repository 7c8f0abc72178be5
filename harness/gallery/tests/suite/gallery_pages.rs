//! The gallery's pages: what they refer to, what they weigh, and how they behave for a reader with
//! Chromium and a keyboard. The site is built once for all these tests.
//!
//! Without Chromium, the tests in it say so and pass. With `LAPIDARY_CHROMIUM=required`, as in
//! `.ci/run`, they fail.

pub(crate) mod browser;
mod html;
mod keyboard;
pub(crate) mod site;

use browser::opened;
use html::Piece;
use lapidary_browser::Page;
use lapidary_cookbook as cookbook;
use lapidary_gallery::choices;
use site::{Site, SitePage, decoded, files, resolved, site};
use std::collections::{BTreeMap, BTreeSet};

/// Most bytes of a page without its pictures: HTML, styles, scripts and fonts.
const MOST_PAGE: u64 = 500_000;
/// Most bytes before a page's first paint: HTML, styles, scripts that it waits for, fonts asked for at once.
const MOST_FIRST: u64 = 300_000;
/// Most bytes of the site.
const MOST_SITE: u64 = 30_000_000;
/// Unless the suite is run whole, one page in this many is opened.
const ONE_IN: u64 = 24;

/// Attributes with an address.
const ADDRESSES: [&str; 4] = ["href", "src", "data-src", "poster"];

/// How the names of the shaders of rungs begin.
const OF_RUNG: &str = "source/rung_";

/// An address in a page or a style.
struct Link<'a> {
    /// Where it stands.
    from: &'a str,
    address: String,
    /// Whether the reader goes there, rather than the browser by itself.
    followed: bool,
}

fn links<'a>(site: &'a Site) -> Vec<Link<'a>> {
    let mut links = Vec::new();
    for (from, page) in &site.pages {
        for piece in &page.pieces {
            let Piece::Start(name, attributes) = piece else { continue };
            let found = ADDRESSES.iter().filter_map(|key| attributes.get(*key).cloned());
            let set = attributes.get("srcset").into_iter().flat_map(|set| set.split(','));
            let set = set.map(|candidate| candidate.split_whitespace().next().unwrap_or_default().to_owned());
            links.extend(found.chain(set).map(|address| Link { from, address, followed: name == "a" }));
        }
    }
    links
}

/// The addresses that the search offers, as links of the start page.
fn found_links(site: &Site) -> Vec<Link<'static>> {
    let entries = delivered(site, "search");
    let entries = entries.as_array().expect("a list").iter();
    let address = |entry: &serde_json::Value| entry["path"].as_str().expect("a path").to_owned();
    entries.map(|entry| Link { from: "index.html", address: address(entry), followed: true }).collect()
}

/// The addresses in a stylesheet.
fn in_style(text: &str) -> Vec<String> {
    let parts = text.split("url(").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0));
    parts.map(|address| address.trim().trim_matches(['"', '\'']).to_owned()).collect()
}

/// Whether a page has what the part after `#` names: an id, or a state that one of its scripts reads.
fn has_anchor(page: &SitePage, address: &str) -> bool {
    let Some((_, anchor)) = address.split_once('#') else { return true };
    match anchor.split_once('=') {
        Some(("picture", name)) => page.pictures.contains(&decoded(name)),
        Some(("compare", value)) => {
            let parts: Vec<String> = value.split(',').map(decoded).collect();
            let [ladder, left, right] = parts.as_slice() else { return false };
            page.ladders.get(ladder).is_some_and(|rungs| rungs.contains(left) && rungs.contains(right))
        }
        // A live page's own: its controls by their names, and the eye.
        Some(_) => {
            let known =
                |part: &str| part.split_once('=').is_some_and(|(key, _)| key == "view" || page.controls.contains(key));
            page.is_live && anchor.split('&').all(known)
        }
        None => anchor.is_empty() || anchor == "top" || page.ids.contains(&decoded(anchor)),
    }
}

#[test]
fn every_link_leads_somewhere() {
    let site = site();
    let all: BTreeSet<String> = files(&site.folder).into_iter().collect();
    let mut wrong = Vec::new();
    let mut links = links(site);
    assert!(links.len() > 1000, "{}", links.len());
    let found = found_links(site);
    assert!(found.len() > 100, "{}", found.len());
    links.extend(found);
    for Link { from, address, followed } in &links {
        let fine = match resolved(from, address) {
            Some(path) => all.contains(&path) && site.pages.get(&path).is_none_or(|page| has_anchor(page, address)),
            // The reader may leave the site; the browser fetches nothing from elsewhere.
            None => *followed && address.starts_with("https://") || address.starts_with("data:"),
        };
        if !fine {
            wrong.push(format!("{from}: {address}"));
        }
    }
    for style in all.iter().filter(|path| path.starts_with("assets/") && path.ends_with(".css")) {
        let text = std::fs::read_to_string(site.folder.join(style)).expect("a stylesheet");
        let lost = |address: &String| {
            !address.starts_with("data:")
                && !address.starts_with('#')
                && resolved(style, address).is_none_or(|path| !all.contains(&path))
        };
        wrong.extend(in_style(&text).into_iter().filter(lost).map(|address| format!("{style}: {address}")));
    }
    wrong.sort();
    wrong.dedup();
    assert!(wrong.is_empty(), "{} links lead nowhere:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn an_anchor_is_an_id_or_a_state() {
    let page = SitePage::of(
        "<h2 id=\"here\"></h2><a class=\"big picture\" href=\"../images/gem/a+b.jpg\"></a><a href=\"c.jpg\"></a>
        <figure class=\"compare\" data-ladder=\"convex\"><select data-side=\"left\"><option value=\"walk-8+tracker\">
        <option value=\"surface\"></select></figure><select><option value=\"other\"></select>",
    );
    let cases = [
        ("a.html", true),
        ("a.html#here", true),
        ("#there", false),
        ("#picture=a%2Bb", true),
        ("#picture=c", false),
        ("#picture=", false),
        ("#compare=convex,walk-8%2Btracker,surface", true),
        ("#compare=convex,surface,other", false),
        ("#compare=convex,surface", false),
        ("#compare=concave,surface,surface", false),
        ("#ior=2.4", false),
    ];
    for (address, expected) in cases {
        assert_eq!(has_anchor(&page, address), expected, "{address}");
    }
    let live = SitePage::of("<section class=\"live\"><input name=\"index\"></section>");
    let cases =
        [("#index=2.4", true), ("#index=2.4&view=1,2,3", true), ("#ior=2.4", false), ("#index=2.4&ior=1", false)];
    for (address, expected) in cases {
        assert_eq!(has_anchor(&live, address), expected, "{address}");
    }
    assert_eq!(in_style("@font-face { src: url(\"a.woff2\") } b { mask: url( c.svg ) }"), ["a.woff2", "c.svg"]);
}

/// Every page can be reached from the start page.
#[test]
fn every_page_is_linked() {
    let site = site();
    let mut to: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for Link { from, address, followed } in links(site) {
        if followed {
            to.entry(from).or_default().extend(resolved(from, &address));
        }
    }
    let mut reached: BTreeSet<String> = BTreeSet::new();
    let mut open = vec!["index.html".to_owned()];
    while let Some(path) = open.pop() {
        if reached.insert(path.clone()) {
            open.extend(to.get(path.as_str()).into_iter().flatten().cloned());
        }
    }
    let lost: Vec<&String> = site.pages.keys().filter(|path| !reached.contains(*path)).collect();
    assert!(lost.is_empty(), "{lost:?}");
}

/// Bytes of a page without its pictures, and of what comes before its first paint.
fn weight(site: &Site, path: &str, page: &SitePage) -> [u64; 2] {
    let (mut all, mut first) = (page.bytes, page.bytes);
    for piece in &page.pieces {
        let Piece::Start(name, attributes) = piece else { continue };
        let value_of = |key: &str| attributes.get(key).map(String::as_str);
        let waits = match (name.as_str(), value_of("rel")) {
            ("script", _) => {
                value_of("defer").is_none() && value_of("async").is_none() && value_of("type") != Some("module")
            }
            ("link", Some("stylesheet" | "preload")) => true,
            _ => continue,
        };
        let address = if name == "script" { value_of("src") } else { value_of("href") };
        let Some(file) = address.and_then(|address| resolved(path, address)) else { continue };
        let bytes = site.bytes(&file);
        all += bytes;
        if waits {
            first += bytes;
        }
        if file.ends_with(".css") {
            let text = std::fs::read_to_string(site.folder.join(&file)).expect("a stylesheet");
            let fonts = in_style(&text).into_iter().filter_map(|address| resolved(&file, &address));
            all += fonts.map(|font| site.bytes(&font)).sum::<u64>();
        }
    }
    [all, first]
}

#[test]
fn pages_are_light() {
    let site = site();
    assert!(site.pages.len() > 50, "{}", site.pages.len());
    let mut wrong = Vec::new();
    let mut most = [(0, ""); 2];
    for (path, page) in &site.pages {
        let bytes = weight(site, path, page);
        for (place, (bytes, bound)) in bytes.into_iter().zip([MOST_PAGE, MOST_FIRST]).enumerate() {
            most[place] = most[place].max((bytes, path));
            if bytes > bound {
                wrong.push(format!("{path}: {bytes} bytes {}", ["in all", "before its first paint"][place]));
            }
        }
    }
    let whole = site.all_bytes();
    println!("{} pages, {whole} bytes; heaviest {most:?}", site.pages.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(whole <= MOST_SITE, "{whole} bytes");
}

/// A page tells what it is: a title of its own, a language, one heading of the first level, a main part,
/// and words in place of every picture.
#[test]
fn pages_say_what_they_are() {
    let mut titles = BTreeSet::new();
    for (path, page) in &site().pages {
        let mut count: BTreeMap<&str, usize> = BTreeMap::new();
        let mut title = None;
        for (index, piece) in page.pieces.iter().enumerate() {
            let Piece::Start(name, attributes) = piece else { continue };
            *count.entry(name).or_default() += 1;
            match (name.as_str(), page.pieces.get(index + 1)) {
                ("title", Some(Piece::Text(text))) => title = title.or_else(|| Some(text.clone())),
                ("html", _) => assert_eq!(attributes.get("lang").map(String::as_str), Some("en"), "{path}"),
                ("img", _) => {
                    let has = |key: &&str| !attributes.contains_key(*key);
                    let missing: Vec<&str> = ["alt", "width", "height"].into_iter().filter(has).collect();
                    assert!(missing.is_empty(), "{path}: an image without {missing:?}: {attributes:?}");
                }
                _ => {}
            }
        }
        for name in ["h1", "main"] {
            assert_eq!(count.get(name), Some(&1), "{path}: {name}");
        }
        let title = title.unwrap_or_else(|| panic!("{path}: no title"));
        assert!(titles.insert(title.clone()), "{path}: another page is called {title} too");
    }
}

/// A text of WGSL with a button that copies it.
struct Listing {
    /// Its file's name.
    file: String,
    /// The text in the page, or the one that the button loads.
    text: String,
}

/// Returns the listings of a page.
fn listings(site: &Site, page: &SitePage) -> Vec<Listing> {
    let is_source = |piece: &Piece| piece.has_class("source");
    let starts: Vec<usize> = (0..page.pieces.len()).filter(|index| is_source(&page.pieces[*index])).collect();
    let mut found = Vec::new();
    for (nth, start) in starts.iter().enumerate() {
        let Piece::Start(_, attributes) = &page.pieces[*start] else { unreachable!("a start") };
        // Listings do not stand in one another.
        let within = &page.pieces[*start..starts.get(nth + 1).copied().unwrap_or(page.pieces.len())];
        let index_of = |wanted: &str| {
            let is_it =
                |piece: &Piece| piece.has_class(wanted) || matches!(piece, Piece::Start(name, _) if name == wanted);
            within.iter().position(is_it)
        };
        let file = index_of("file").map(|place| text_until(&within[place..], "span")).unwrap_or_default();
        if !page.pieces[*start].has_class("copyable") || !file.ends_with(".wgsl") {
            continue;
        }
        let text = match attributes.get("data-source") {
            Some(name) => source(site, name),
            None => text_until(&within[index_of("pre").unwrap_or_else(|| panic!("{file}: no text"))..], "pre"),
        };
        found.push(Listing { file, text });
    }
    found
}

/// The names of what a page's buttons load to copy it, wherever they stand.
fn sources(page: &SitePage) -> impl Iterator<Item = &str> {
    page.pieces.iter().filter_map(|piece| match piece {
        Piece::Start(_, attributes) => attributes.get("data-source").map(String::as_str),
        _ => None,
    })
}

/// The text up to the end of an element.
fn text_until(pieces: &[Piece], end: &str) -> String {
    let within = pieces.iter().take_while(|piece| !matches!(piece, Piece::End(name) if name == end));
    within.filter_map(|piece| if let Piece::Text(text) = piece { Some(text.as_str()) } else { None }).collect()
}

/// The value that a script of data delivers.
fn delivered(site: &Site, name: &str) -> serde_json::Value {
    let path = site.folder.join(format!("data/{name}.js"));
    let script = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let value =
        script.trim().strip_prefix(&format!("gallery.deliver(\"{name}\",")).and_then(|rest| rest.strip_suffix(");"));
    serde_json::from_str(value.unwrap_or_else(|| panic!("{name}: another call")))
        .unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The text that a button loads.
fn source(site: &Site, name: &str) -> String {
    delivered(site, name).as_str().unwrap_or_else(|| panic!("{name}: no text")).to_owned()
}

/// What a copy button puts into the clipboard is complete WGSL; tests below hold the clipboard to the page.
#[test]
fn copied_listings_compile() {
    let (site, mut count) = (site(), 0);
    for (path, page) in &site.pages {
        for Listing { file, text } in listings(site, page) {
            // A naive form stands below its module.
            let module = file.strip_prefix("naive/").and_then(|name| cookbook::module(name.trim_end_matches(".wgsl")));
            let whole = format!("{}{text}", module.map_or("", |module| module.source));
            if let Err(error) = lapidary_specialise::parse(&whole, &file) {
                panic!("{path}: {file}: {error}");
            }
            assert!(text.contains("fn "), "{path}: {file}: {text}");
            count += 1;
        }
    }
    let least = cookbook::modules().len() + lapidary_wgsl::RECIPES.len();
    assert!(count >= least, "{count} listings, of {least} modules and recipes");
}

/// The same for every text that is loaded, in listings or tables; each once.
#[test]
fn loaded_sources_compile() {
    let site = site();
    let names: BTreeSet<&str> = site.pages.values().flat_map(sources).collect();
    for name in &names {
        let text = source(site, name);
        if let Err(error) = lapidary_specialise::parse(&text, name) {
            panic!("{name}: {error}");
        }
        assert!(text.contains("fn "), "{name}: {text}");
    }
    let rungs = names.iter().filter(|name| name.starts_with(OF_RUNG)).count();
    assert_eq!(rungs, choices::all().len(), "a shader for each rung to choose of each ladder: {names:?}");
    for choice in choices::all() {
        let named = |text: &str| text.starts_with(&format!("// The rung {}, by ./cook copy ", choice.rung));
        let of_ladder = format!("{OF_RUNG}{}_", choice.ladder);
        let is_there = names.iter().filter(|name| name.starts_with(&of_ladder)).any(|name| named(&source(site, name)));
        assert!(is_there, "{}: no shader that names it", choice.rung);
    }
    let least = cookbook::modules().len() + lapidary_wgsl::RECIPES.len() + rungs;
    assert!(names.len() >= least, "{} sources, of {least} modules, recipes and rungs", names.len());
}

/// A handful of pages: one of each folder, a live page or two, whose controls differ, and some more by the suite's seed.
fn some_pages() -> Vec<&'static str> {
    let site = site();
    let mut chosen: BTreeSet<&str> = BTreeSet::from(["index.html"]);
    for folder in ["guides/", "live/", "modules/", "recipes/", "techniques/"] {
        chosen.insert(site.first(folder));
    }
    let live = site.pages.keys().map(String::as_str).filter(|path| path.starts_with("live/"));
    chosen.extend(lapidary_testing::sampled(live, 4));
    chosen.extend(lapidary_testing::sampled(site.pages.keys().map(String::as_str), ONE_IN));
    chosen.into_iter().collect()
}

/// A phone's window and a desktop's: width, height, whether it is a phone.
const WINDOWS: [(u32, u32, bool); 2] = [(390, 844, true), (1440, 900, false)];

/// From a file, in light and dark, on a phone and a desktop: no error is told, nothing is fetched from outside
/// the folder, and nothing is wider than the window.
#[test]
fn pages_are_quiet_and_fit_their_window() {
    let Some(mut page) = browser::started() else { return };
    let mut wrong = Vec::new();
    for path in some_pages() {
        for (width, height, is_phone) in WINDOWS {
            page.set_viewport(width, height, is_phone).expect("set");
            for dark in [false, true] {
                // Unless the suite is run whole, a phone is dark and a desktop is light.
                if dark != is_phone && !lapidary_testing::whole() {
                    continue;
                }
                page.set_media(dark, true).expect("set");
                let place = format!("{path} ({width} px, {})", if dark { "dark" } else { "light" });
                wrong.extend(faults(&mut page, path).into_iter().map(|fault| format!("{place}: {fault}")));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// On a phone the menu begins below the bar, ends in the window, and can be scrolled to its last page.
#[test]
fn a_phones_menu_reaches_every_page() {
    let Some(mut page) = opened("modules/refraction.html") else { return };
    let (width, height, is_phone) = WINDOWS[0];
    page.set_viewport(width, height, is_phone).expect("set");
    page.click("button.menu").expect("clicked");
    let menu = page
        .run(
            "const contents = document.querySelector('#contents');
            const box = contents.getBoundingClientRect();
            for (const fold of contents.querySelectorAll('details')) fold.open = true;
            const all = [...contents.querySelectorAll('a')];
            all.at(-1).scrollIntoView({ block: 'nearest', behavior: 'instant' });
            const last = all.at(-1).getBoundingClientRect();
            const seen = document.elementFromPoint(last.left + 5, last.top + last.height / 2);
            return {
              below: box.top >= document.querySelector('.bar').getBoundingClientRect().bottom - 1,
              within: box.bottom <= innerHeight + 1,
              long: contents.scrollHeight > contents.clientHeight,
              last: seen === all.at(-1),
            };",
        )
        .expect("the menu");
    assert_eq!(menu, serde_json::json!({ "below": true, "within": true, "long": true, "last": true }));
}

/// Opens a page of the site, and returns what is wrong with it.
fn faults(page: &mut Page, path: &str) -> Vec<String> {
    let home = site().address("");
    page.open(&site().address(path)).expect(path);
    // Down to its end, so that lazy pictures come too.
    page.run(browser::SCROLL).expect(path);
    let mut wrong = Vec::new();
    for (what, script) in [("wider than the window", browser::WIDER), ("pictures that are none", browser::BROKEN)] {
        let found = page.evaluate(script).expect(path);
        if found != serde_json::json!([]) {
            wrong.push(format!("{what}: {found}"));
        }
    }
    wrong.extend(page.problems().expect(path).iter().cloned());
    let inside = |address: &str| ["data:", "blob:", home.as_str()].iter().any(|start| address.starts_with(*start));
    let outside = page.requests().expect(path).iter().filter(|address| !inside(address));
    wrong.extend(outside.map(|address| format!("it asks for {address}")));
    wrong
}

/// The button's text is what the page shows, to the letter.
#[test]
fn a_copy_button_copies_what_is_shown() {
    let Some(mut page) = opened("modules/refraction.html") else { return };
    page.grant_clipboard().expect("granted");
    let all = listings(site(), &site().pages["modules/refraction.html"]);
    let listing = all.into_iter().find(|listing| listing.file == "refraction.wgsl").expect("a listing");
    let shown = page
        .run(
            "const source = [...document.querySelectorAll('.source.copyable')]
                .find((part) => part.querySelector('.file').textContent === 'refraction.wgsl');
            source.querySelector('button.copy').id = 'the-button';
            return source.querySelector('pre').textContent;",
        )
        .expect("the listing's button");
    page.click("#the-button").expect("clicked");
    let copied = page.wait_for("navigator.clipboard.readText()", browser::SOON).expect("a clipboard");
    let copied = copied.as_str().expect("a text");
    assert_eq!(copied.trim(), listing.text.trim());
    assert_eq!(copied.trim(), shown.as_str().expect("a text").trim());
    // It says so, to eyes and to screen readers.
    let said = page.wait_for("document.querySelector('#status').textContent", browser::SOON).expect("words");
    assert!(said.as_str().is_some_and(|said| said.to_lowercase().contains("cop")), "{said}");
    // Each command of the page is copied whole.
    let commands = page
        .run(
            "const wrong = [];
            for (const part of document.querySelectorAll('.command.copyable')) {
              part.querySelector('button.copy').click();
              await new Promise((done) => setTimeout(done, 50));
              const copied = await navigator.clipboard.readText();
              const shown = part.querySelector('code').textContent;
              if (copied.trim() !== shown.trim()) wrong.push([shown, copied]);
            }
            return wrong;",
        )
        .expect("copied");
    assert_eq!(commands, serde_json::json!([]));
}

/// A cell of the table of rungs shows no text: its button copies the shader that it names, whole.
#[test]
fn a_button_of_a_rung_copies_its_shader() {
    let of_rung = |page: &'static SitePage| sources(page).find(|name| name.starts_with(OF_RUNG));
    let found = site().pages.iter().find_map(|(path, page)| Some((path, of_rung(page)?)));
    let (path, name) = found.expect("a rung's shader");
    let Some(mut page) = opened(path) else { return };
    page.grant_clipboard().expect("granted");
    let mark = format!(
        "await navigator.clipboard.writeText('');
        document.querySelector('td.copyable.cell[data-source=\"{name}\"] button.copy').id = 'the-button';"
    );
    page.run(&mark).expect("a cell with a button");
    page.click("#the-button").expect("clicked");
    let copied = page.wait_for("navigator.clipboard.readText()", browser::SOON).expect("a clipboard");
    assert_eq!(copied.as_str().expect("a text"), source(site(), name), "{path}: {name}");
    assert_eq!(page.problems().expect("a list"), [] as [String; 0]);
}
