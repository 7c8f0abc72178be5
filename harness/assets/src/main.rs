//! Writes the glTF files that this project made itself into `harness/assets/` or into the folder given
//! as an argument: `cargo run --package lapidary-assets`.

use lapidary_scene::glb;
use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> ExitCode {
    match write() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

fn write() -> Result<(), String> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    for (name, scene) in lapidary_assets::files().map_err(|error| error.to_string())? {
        let bytes = glb::write(&scene).map_err(|error| format!("{name}: {error}"))?;
        let path = folder.join(name);
        std::fs::write(&path, &bytes).map_err(|error| format!("{}: cannot be written: {error}", path.display()))?;
        println!("{}: {} bytes", path.display(), bytes.len());
    }
    Ok(())
}
