//! Tests of the site, in Chromium where a page runs.

mod environment_js;
mod gallery_live;
mod gallery_pages;
mod gallery_rows;
