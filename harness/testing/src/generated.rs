//! Files of the repository that a test generates.

use lapidary_cookbook::repository;

/// Fails if a file, by its path from the repository's folder, holds another text. `./cook test --refresh`
/// writes it instead.
pub fn keep(file: &str, text: &str) {
    let path = repository::place().join(file);
    if std::fs::read_to_string(&path).is_ok_and(|written| written == text) {
        return;
    }
    assert!(std::env::var_os("LAPIDARY_REFRESH_PAGES").is_some(), "{file} is not as generated: ./cook test --refresh");
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
    std::fs::write(&path, text).expect("written");
}
