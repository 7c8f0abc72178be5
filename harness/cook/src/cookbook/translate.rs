//! Translation of the cookbook's WGSL to other shading languages, by naga's writers.

use naga::back;

/// Output language (`--to`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Target {
    /// The cookbook's own text.
    Wgsl,
    /// SPIR-V binary, little endian.
    Spirv,
    /// HLSL, shader model 5.1.
    Hlsl,
    /// Metal Shading Language.
    Msl,
    /// GLSL 4.50, one entry point.
    Glsl,
}

impl Target {
    /// Whether the target only supports whole shaders, so that a module's functions need an entry
    /// point.
    pub fn needs_entry_point(self) -> bool {
        matches!(self, Self::Spirv | Self::Glsl)
    }
}

/// Writes a validated module. A GLSL text has one entry point, given by name; other targets include
/// all.
///
/// Returns the bytes of the text or of the SPIR-V words; an error holds the writer's own message.
pub fn translate(
    module: &naga::Module,
    info: &naga::valid::ModuleInfo,
    target: Target,
    entry_point: Option<(&str, naga::ShaderStage)>,
) -> Result<Vec<u8>, String> {
    match target {
        Target::Wgsl => back::wgsl::write_string(module, info, back::wgsl::WriterFlags::empty())
            .map(String::into_bytes)
            .map_err(|error| error.to_string()),
        Target::Spirv => {
            let options = back::spv::Options::default();
            back::spv::write_vec(module, info, &options, None)
                .map(|words| words.iter().flat_map(|word| word.to_le_bytes()).collect())
                .map_err(|error| error.to_string())
        }
        Target::Hlsl => {
            let mut text = String::new();
            let options = back::hlsl::Options::default();
            let pipeline = back::hlsl::PipelineOptions::default();
            back::hlsl::Writer::new(&mut text, &options, &pipeline)
                .write(module, info, None)
                .map_err(|error| error.to_string())?;
            Ok(text.into_bytes())
        }
        Target::Msl => {
            // Instances have numbers from version 1.2 on.
            let lang_version = (2, 0);
            let options =
                back::msl::Options { lang_version, fake_missing_bindings: true, ..back::msl::Options::default() };
            back::msl::write_string(module, info, &options, &back::msl::PipelineOptions::default())
                .map(|(text, _)| text.into_bytes())
                .map_err(|error| error.to_string())
        }
        Target::Glsl => {
            let Some((name, shader_stage)) = entry_point else {
                return Err("GLSL needs an entry point".to_owned());
            };
            let options = back::glsl::Options { version: back::glsl::Version::Desktop(450), ..Default::default() };
            let pipeline = back::glsl::PipelineOptions { shader_stage, entry_point: name.to_owned(), multiview: None };
            let mut text = String::new();
            back::glsl::Writer::new(
                &mut text,
                module,
                info,
                &options,
                &pipeline,
                naga::proc::BoundsCheckPolicies::default(),
            )
            .and_then(|mut writer| writer.write())
            .map_err(|error| error.to_string())?;
            Ok(text.into_bytes())
        }
    }
}
