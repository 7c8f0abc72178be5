//! A page of the site in Chromium.

use super::site::site;
use lapidary_browser::{Browser, Page};
use std::io::Write as _;
use std::time::Duration;

/// Time for what follows a key or a click at once; generous, since other tests run beside it.
pub(crate) const SOON: Duration = Duration::from_secs(20);

/// Scrolls to the end of the page, window by window, and waits for its pictures.
pub(super) const SCROLL: &str = "
    for (let y = 0; y < document.documentElement.scrollHeight; y += 800) {
      scrollTo(0, y);
      await new Promise((done) => setTimeout(done, 10));
    }
    scrollTo(0, 0);
    const shown = [...document.images].filter((image) => image.offsetParent && !image.complete);
    const ended = (image) => new Promise((done) => { image.onload = image.onerror = done; setTimeout(done, 2000); });
    await Promise.all(shown.map(ended));";

/// The innermost elements that are wider than the window, if the page can be scrolled sideways.
pub(super) const WIDER: &str = "(() => {
    const root = document.documentElement;
    if (root.scrollWidth <= innerWidth) return [];
    const wide = (element) => element.getBoundingClientRect().right > innerWidth + 1;
    const all = [...document.body.querySelectorAll('*')].filter(wide);
    const innermost = all.filter((element) => ![...element.children].some(wide));
    return [`${root.scrollWidth} pixels`, ...innermost.slice(0, 5).map((element) => element.outerHTML.slice(0, 160))];
})()";

/// Pictures that were loaded and are none.
pub(super) const BROKEN: &str =
    "[...document.images].filter((image) => image.complete && image.src && image.offsetParent && !image.naturalWidth)
    .map((image) => image.getAttribute('src'))";

/// Starts a browser; nothing without Chromium.
pub(crate) fn started() -> Option<Page> {
    let required = std::env::var_os("LAPIDARY_CHROMIUM").is_some_and(|value| value == "required");
    let Some(program) = Browser::find() else {
        assert!(!required, "LAPIDARY_CHROMIUM=required: no Chromium on the PATH");
        let name = std::thread::current().name().unwrap_or_default().to_owned();
        // Bypasses the test's own capture, which shows nothing of a passing test.
        let _ = writeln!(std::io::stderr(), "{name}: not checked: no Chromium on the PATH");
        return None;
    };
    let mut page = Page::start(&program).expect("a browser");
    page.set_viewport(1440, 900, false).expect("set");
    page.set_media(false, true).expect("set");
    Some(page)
}

/// Starts a browser at a page of the site; nothing without Chromium.
pub(crate) fn opened(path: &str) -> Option<Page> {
    let mut page = started()?;
    page.open(&site().address(path)).expect(path);
    Some(page)
}
