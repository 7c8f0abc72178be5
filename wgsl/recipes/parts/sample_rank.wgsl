// sample_rank: numbers for neighbouring samples, spread so that any few of them differ.
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Source: Bayer, "An optimum method for two-level rendition of continuous-tone pictures", ICC 1973.
//
// A recipe adds: nothing.

// A number that nobody foresees, from 0 to 15, for each 4 x 4 samples and body: an integer hash.
fn sample_shift(place: vec2u, body: u32) -> u32 {
    var v = (place.x >> 2u) + 1664525u * (place.y >> 2u) + 1013904223u * body;
    v = (v ^ (v >> 16u)) * 2146121005u;
    v = (v ^ (v >> 15u)) * 2221713035u;
    return v >> 28u;
}

// The rank of a sample among 4 x 4, from 0 to 15, by its place in the frame. With 16 samples for a pixel, each
// pixel has every rank once.
fn sample_rank(place: vec2u) -> u32 {
    let across = place.x ^ place.y;
    return 8u * (across & 1u) + 4u * (place.y & 1u) + 2u * ((across >> 1u) & 1u) + ((place.y >> 1u) & 1u);
}
