//! A specialised shader gives the same bits on the device as the whole one, whatever its contents.

mod program;
mod recipes;

pub(crate) use recipes::specialised_texts;

use lapidary_assay::dispatch::{self, ENTRY_POINT, Kernel, KernelModule};
use lapidary_assay::draws::Draws;
use lapidary_assay::runner::Runner;
use lapidary_specialise::specialise;
use lapidary_testing::gpu;
use naga::back;
use program::{random_constants, random_program};

const SEED: u64 = 0x5bec;
/// Number of programs to run. Each is compiled twice.
const RUN: u64 = 60;
/// Number of programs to specialise and write.
const WRITTEN: u64 = 300;
/// Number of calls of each program.
const ROWS: usize = 256;

/// Returns the source and kernel of a random program, with values for its overrides.
fn kernel(row: u64) -> (String, KernelModule, Vec<(&'static str, f64)>) {
    let mut draws = Draws::of_row(SEED ^ lapidary_testing::seed(), row);
    let source = random_program(&mut draws);
    let constants = random_constants(&mut draws);
    let kernel = KernelModule::reflect(&source, "program", "subject").unwrap_or_else(|e| panic!("{e}\n{source}"));
    (source, kernel, constants)
}

fn specialised(kernel: &KernelModule, constants: &[(&str, f64)]) -> KernelModule {
    let (module, _) = specialise(kernel.module.clone(), constants, &[ENTRY_POINT]).unwrap_or_else(|e| panic!("{e}"));
    let mut special = kernel.clone();
    special.module = module;
    special
}

/// Returns a random program, specialised, as WGSL.
pub(crate) fn specialised_program(row: u64) -> String {
    let (_, kernel, constants) = kernel(row);
    written(&specialised(&kernel, &constants).module, row)
}

/// Returns a valid module as WGSL.
fn written(module: &naga::Module, row: u64) -> String {
    let info = lapidary_specialise::validate(module).unwrap_or_else(|error| panic!("program {row}: {error}"));
    back::wgsl::write_string(module, &info, back::wgsl::WriterFlags::empty())
        .unwrap_or_else(|error| panic!("program {row}: {error}"))
}

/// Returns `x` and `n` of each call.
fn arguments(draws: &mut Draws<'_>) -> Vec<u32> {
    (0..ROWS).flat_map(|_| [draws.between(-2.0, 2.0).to_bits(), draws.bits()]).collect()
}

fn outcomes(kernel: KernelModule, constants: &[(&str, f64)], arguments: &[u32]) -> Vec<u32> {
    let mut kernel = Kernel::with_constants(gpu(), kernel, constants).unwrap_or_else(|error| panic!("{error}"));
    let mut results = Vec::new();
    kernel.run(arguments, &mut results).unwrap_or_else(|error| panic!("{error}"));
    results
}

/// Largest difference between two sums of the same terms in another order. A driver may add up
/// constants first, and lavapipe does so once specialising has made them constants. Terms are at
/// most 8 by their clamps, so a sum of three is off by 4e-6; two products by up to 8 may follow.
const REORDERED: f32 = 3e-4;

/// Whether two results agree: hashes, of the path through the program, in every bit; values up to the
/// order of their sums.
fn agree(word: usize, whole: u32, special: u32) -> bool {
    let [value, other] = [whole, special].map(f32::from_bits);
    whole == special || word.is_multiple_of(2) && (value - other).abs() <= REORDERED
}

#[test]
fn a_specialised_program_gives_the_same_bits() {
    let (mut varied, mut sensitive, mut others) = (0, 0, 0);
    for row in 0..RUN {
        let (source, kernel, constants) = kernel(row);
        let arguments = arguments(&mut Draws::of_row((SEED + 1) ^ lapidary_testing::seed(), row));
        let whole = outcomes(kernel.clone(), &constants, &arguments);
        let special = outcomes(specialised(&kernel, &constants), &[], &arguments);
        if let Some(word) = (0..whole.len()).find(|word| !agree(*word, whole[*word], special[*word])) {
            let call = word / 2;
            panic!(
                "program {row} with {constants:?}: subject({}, {}): word {} is {:#x}, specialised {:#x}\n{source}",
                f32::from_bits(arguments[2 * call]),
                arguments[2 * call + 1],
                word % 2,
                whole[word],
                special[word],
            );
        }
        varied += u32::from(whole.chunks(2).any(|outcome| outcome != &whole[..2]));
        // Now and then, check that other override values would have been seen.
        if row % 6 == 0 {
            let turned: Vec<_> = constants.iter().map(|(name, value)| (*name, 1.0 - value.min(1.0))).collect();
            others += 1;
            sensitive += u32::from(outcomes(specialised(&kernel, &turned), &[], &arguments) != whole);
        }
    }
    assert!(varied * 2 > RUN as u32, "only {varied} of {RUN} programs depend on their arguments");
    assert!(sensitive * 2 > others, "only {sensitive} of {others} programs depend on their overrides");
}

/// Counts the branches, switches and loops in WGSL text.
fn decisions(text: &str) -> usize {
    ["if ", "switch ", "for ", "loop "].iter().map(|word| text.matches(word).count()).sum()
}

/// A specialised program can be written as SPIR-V and as WGSL, read back, and specialised again
/// without a change.
#[test]
fn a_specialised_program_can_be_written_and_is_final() {
    let (mut before, mut after) = (0, 0);
    for row in 0..WRITTEN {
        let (source, kernel, constants) = kernel(row);
        let write = |module: &naga::Module| {
            let info = lapidary_specialise::validate(module).unwrap_or_else(|error| panic!("program {row}: {error}"));
            back::spv::write_vec(module, &info, &back::spv::Options::default(), None)
                .unwrap_or_else(|error| panic!("program {row}: {error}"));
            written(module, row)
        };
        let special = specialised(&kernel, &constants);
        let text = write(&special.module);
        dispatch::parse(&text, "specialised").unwrap_or_else(|error| panic!("program {row}: {error}"));
        assert_eq!(write(&specialised(&special, &[]).module), text, "program {row} with {constants:?}:\n{source}");
        before += decisions(&source);
        after += decisions(&text);
    }
    assert!(after * 2 < before, "{after} of {before} decisions are left");
}
