//! Draws a cut stone with bare wgpu and Lapidary's WGSL, without a window.

mod draw;
mod stone;

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::process::ExitCode;

/// Pixels along each side of the picture.
const SIZE: u32 = 512;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [glb, picture] = &arguments[..] else {
        eprintln!("Usage: lapidary-in-wgpu STONE.glb PICTURE.png");
        return ExitCode::from(2);
    };
    match picture_of(glb, picture) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("lapidary-in-wgpu: {error}");
            ExitCode::FAILURE
        }
    }
}

fn picture_of(glb: &str, picture: &str) -> Result<(), Box<dyn Error>> {
    let stone = stone::read(glb).map_err(|error| format!("{glb}: {error}"))?;
    let pixels = pollster::block_on(draw::draw(&stone, SIZE))?;
    let file = File::create(picture).map_err(|error| format!("{picture}: {error}"))?;
    let mut encoder = png::Encoder::new(BufWriter::new(file), SIZE, SIZE);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(())
}
