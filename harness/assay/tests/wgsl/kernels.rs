//! Tests of kernels on whole buffers.

use glam::Vec3;
use lapidary_assay::{Outcome, kernel};
use proptest::prelude::*;

/// A blur of three, particles in a struct, a histogram with atomics, and a texture lookup.
const KERNELS: &str = "
override RADIUS: u32 = 1u;

struct Particle {
    place: vec3f,
    speed: f32,
}

@group(0) @binding(0) var<storage, read> source: array<f32>;
@group(0) @binding(1) var<storage, read_write> target_values: array<f32>;
@group(1) @binding(0) var<uniform> step: f32;
@group(1) @binding(1) var<storage, read_write> particles: array<Particle>;
@group(2) @binding(0) var<storage, read> numbers: array<u32>;
@group(2) @binding(1) var<storage, read_write> counts: array<atomic<u32>>;
@group(3) @binding(0) var picture: texture_2d<f32>;

@compute @workgroup_size(64)
fn blur(@builtin(global_invocation_id) id: vec3u) {
    let count = arrayLength(&target_values);
    if (id.x >= count) {
        return;
    }
    var sum = 0.0f;
    for (var i = 0u; i <= 2u * RADIUS; i++) {
        sum += source[min(max(id.x + i, RADIUS) - RADIUS, count - 1u)];
    }
    target_values[id.x] = sum / f32(2u * RADIUS + 1u);
}

@compute @workgroup_size(64)
fn move_particles(@builtin(global_invocation_id) id: vec3u) {
    if (id.x < arrayLength(&particles)) {
        particles[id.x].place.y += step * particles[id.x].speed;
    }
}

@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) id: vec3u) {
    if (id.x < arrayLength(&numbers)) {
        atomicAdd(&counts[numbers[id.x] % arrayLength(&counts)], 1u);
    }
}

@compute @workgroup_size(1)
fn look(@builtin(global_invocation_id) id: vec3u) {
    target_values[id.x] = textureLoad(picture, id.xy, 0).x;
}
";

#[derive(Clone, Copy, Debug)]
struct Particle {
    place: Vec3,
    speed: f32,
}

lapidary_assay::mirror_struct!(Particle { place, speed });

fn blurred(source: &[f32], radius: usize, target: &mut [f32]) {
    let last = target.len() - 1;
    for (index, value) in target.iter_mut().enumerate() {
        let sum: f32 = (0..=2 * radius).map(|i| source[(index + i).max(radius).min(radius + last) - radius]).sum();
        *value = sum / (2 * radius + 1) as f32;
    }
}

fn signals() -> impl Strategy<Value = (Vec<f32>, Vec<f32>)> {
    prop::collection::vec(-1.0f32..1.0, 1..300).prop_map(|source| (source.clone(), vec![0.0; source.len()]))
}

fn groups_of_64(elements: usize) -> [u32; 3] {
    [u32::try_from(elements.div_ceil(64)).expect("few"), 1, 1]
}

#[test]
fn a_blur_is_its_mirrors() -> Outcome {
    kernel(KERNELS, "blur")
        .constant("RADIUS", 2.0)
        .mirror(|(source, target): &mut (Vec<f32>, Vec<f32>)| blurred(source, 2, target))
        .inputs(signals())
        .workgroups(|(source, _)| groups_of_64(source.len()))
        .edge("more than a workgroup", |(source, _)| source.len() > 64)
        // Five terms of at most 1: four sums and a quotient of 2.5 ulp.
        .within("target_values", "1e-6 abs")
        .run()
}

/// A uniform, and structs with padding.
#[test]
fn particles_move_and_keep_what_else_they_have() -> Outcome {
    kernel(KERNELS, "move_particles")
        .mirror(|(step, particles): &mut (f32, Vec<Particle>)| {
            for particle in particles {
                particle.place.y += *step * particle.speed;
            }
        })
        .draws(|draws| {
            let particles = (0..=draws.below(100))
                .map(|_| Particle { place: draws.in_cube(), speed: draws.between(0.0, 1.0) })
                .collect();
            (draws.between(0.0, 1.0), particles)
        })
        .workgroups(|(_, particles)| groups_of_64(particles.len()))
        .within("particles", "place 3e-7 abs, speed 0 ulp")
        .run()
}

#[test]
fn a_histogram_by_atomics_is_exact() -> Outcome {
    kernel(KERNELS, "count")
        .mirror(|(numbers, counts): &mut (Vec<u32>, Vec<u32>)| {
            let bins = counts.len();
            numbers.iter().for_each(|number| counts[*number as usize % bins] += 1);
        })
        .inputs((prop::collection::vec(any::<u32>(), 1..500), prop::collection::vec(0u32..9, 1..20)))
        .workgroups(|(numbers, _)| groups_of_64(numbers.len()))
        .run()
}

/// The last invocation is left out. The test finds this, and shrinks it to the shortest buffer that
/// shows it.
#[test]
fn a_broken_kernel_fails_with_buffers_to_paste() {
    let broken = KERNELS.replace("if (id.x >= count) {", "if (id.x + 1u >= count) {");
    let message = kernel(broken, "blur")
        .mirror(|(source, target): &mut (Vec<f32>, Vec<f32>)| blurred(source, 1, target))
        .inputs(signals())
        .workgroups(|(source, _)| groups_of_64(source.len()))
        .within("target_values", "1e-6 abs")
        .run()
        .expect_err("broken")
        .to_string();
    for said in [
        "blur: 256 of 256 inputs failed; `target_values[0]` is off by",
        "target_values[0] = 0.0f",
        "  source = array<f32, 1>(",
        "in Rust: (vec![",
        "ASSAY_SEED=",
    ] {
        assert!(message.contains(said), "`{said}` is not in:\n{message}");
    }
}

#[test]
fn what_cannot_be_tested_is_said_in_a_line() {
    let blur = |entry: &'static str, within: (&'static str, &str), empty: bool| {
        kernel(KERNELS, entry)
            .mirror(|(source, target): &mut (Vec<f32>, Vec<f32>)| blurred(source, 1, target))
            .draws(move |draws| {
                let count = if empty { 0 } else { 1 + draws.below(9) as usize };
                (vec![draws.unit() as f32; count], vec![0.0; count])
            })
            .within(within.0, within.1)
            .run()
            .expect_err("refused")
            .to_string()
    };
    let fine = ("target_values", "1e-6 abs");
    for (message, part) in [
        (blur("smear", fine, false), "no compute entry point of that name"),
        (blur("move_particles", fine, false), "buffer `step`: expected array<f32>, found f32"),
        (blur("look", fine, false), "`picture` is no buffer"),
        (blur("blur", ("target", "1e-6 abs"), false), "the entry point uses no buffer `target`"),
        (blur("blur", ("target_values", "2 backward"), false), "no backward error"),
        (blur("blur", fine, true), "`source` is empty"),
    ] {
        assert!(message.contains(part), "`{part}` is not in: {message}");
        assert_eq!(message.lines().count(), 1, "{message}");
    }
    let never = kernel(KERNELS, "count")
        .mirror(|(numbers, counts): &mut (Vec<u32>, Vec<u32>)| {
            let bins = counts.len();
            numbers.iter().for_each(|number| counts[*number as usize % bins] += 1);
        })
        .draws(|draws| (vec![draws.bits()], vec![0; 3]));
    let message = never.edge("two numbers", |(numbers, _)| numbers.len() > 1).run().expect_err("never").to_string();
    assert!(message.contains("no input reached `two numbers`"), "{message}");
    let three = kernel(KERNELS, "blur").mirror(|_: &mut (Vec<f32>, Vec<f32>, u32)| {}).inputs((
        prop::collection::vec(0.0f32..1.0, 1..3),
        prop::collection::vec(0.0f32..1.0, 1..3),
        any::<u32>(),
    ));
    let message = three.run().expect_err("refused").to_string();
    assert!(
        message.contains("the mirror has 3 buffers, the entry point uses 2: `source`, `target_values`"),
        "{message}"
    );
}
