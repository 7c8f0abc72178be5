// microfacet: a rough dielectric's highlight: Cook and Torrance's reflectance, Trowbridge and Reitz's facets (GGX).
// SPDX-License-Identifier: MIT-0 OR Apache-2.0
// Version: 0.2.0
// Source: Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough
//   Surfaces", 2007, eq. (20), (33); Heitz, "Understanding the Masking-Shadowing Function in
//   Microfacet-Based BRDFs", 2014, eq. (72), (99); Lagrange's identity for the squared sine: Guy
//   and Agopian, "Physically Based Rendering in Filament", 4.4.1; visible facets: Dupuy and Benyoub, "Sampling
//   Visible GGX Normals with Spherical Caps", 2023.
//
// `alpha` is the width of the distribution, a slope: the square of glTF's roughness. The Fresnel
// reflectance of a facet is not computed here but passed in: evaluate it at the cosine between
// `microfacet_half` and the light.

// Smaller values of alpha count as this one: on a mirror, the highlight of a point light is too
// small for any pixel to hit.
const MICROFACET_SMOOTHEST: f32 = 0.001f;
// Lower limit of the divisor of the visibility. The limit takes effect if light and eye are both
// within 1e-21 of grazing. It keeps the product with the peak of the distribution, 3.2e5, finite.
const MICROFACET_GRAZING: f32 = 1e-24f;
// Lower limit of the squared length of the sum of two unit vectors. The rounding error of the
// vectors themselves is 1e-7.
const MICROFACET_OPPOSITE: f32 = 1e-30f;

// Distribution of the facets' normals by Trowbridge and Reitz: alpha^2 / (pi (alpha^2 cos^2 + sin^2)^2), of the angle
// between `normal` and `half`. sin^2 is |normal x half|^2, because 1 - cos^2 loses nearly all its digits near alpha.
// Returns: area of facets per area of surface and solid angle, in [0, 1 / (pi alpha^2)]; even in `half`; 0 if either
//   vector is 0.
// Units: 1/sr; alpha is a slope.
// Domain: normal and half of any length in [1e-4, 1e4], or 0; any alpha, clamped to [0.001, 1].
// Outside: finite and not negative as long as the fourth power of the product of the lengths is finite; 0 where its
//   square underflows.
// Accuracy: lavapipe 35 ulp + 1 backward; portable 75 ulp + 2 backward; order kept
fn microfacet_distribution(normal: vec3f, half: vec3f, alpha: f32) -> f32 {
    let a = clamp(alpha, MICROFACET_SMOOTHEST, 1.0f);
    let cosine = dot(normal, half);
    let across = cross(normal, half);
    let cosine_squared = cosine * cosine;
    let sine_squared = dot(across, across);
    let spread = a * a * cosine_squared + sine_squared;
    // A subnormal divisor may be flushed to zero.
    if (spread < 1.2e-38f) {
        return 0.0f;
    }
    // For unit vectors the sum of both squares is 1. Including it makes the result depend on
    // directions only, and keeps the quotient at or below 1 / alpha.
    let quotient = a * (cosine_squared + sine_squared) / spread;
    return 0.31830987f * quotient * quotient;
}

// Smith's height-correlated masking and shadowing, the share of facets that light and eye both see, divided
// by 4 (n . l) (n . v). All factors that tend to 0 at grazing incidence have cancelled, except for one sum.
// Returns: G2 / (4 n.l n.v) = 1/2 / (n.v sqrt(alpha^2 + (1 - alpha^2) n.l^2) + n.l sqrt(alpha^2 + (1 -
//   alpha^2) n.v^2)), in [1/4, 5e23].
// Units: none; the cosines are relative to the surface normal, alpha is a slope.
// Domain: any cosines, clamped to [0, 1]: one below 0, at a silhouette if an interpolated normal faces
//   away, counts as grazing. Any alpha, clamped to [0.001, 1]. A divisor below 1e-24 counts as 1e-24.
// Outside: nothing.
// Accuracy: lavapipe 7 ulp; portable 24 ulp
fn microfacet_visibility(cosine_light: f32, cosine_eye: f32, alpha: f32) -> f32 {
    let a = clamp(alpha, MICROFACET_SMOOTHEST, 1.0f);
    let l = clamp(cosine_light, 0.0f, 1.0f);
    let v = clamp(cosine_eye, 0.0f, 1.0f);
    let squared = a * a;
    let rest = (1.0f - a) * (1.0f + a);
    let shadowing = v * sqrt(squared + rest * l * l);
    let masking = l * sqrt(squared + rest * v * v);
    return 0.5f / max(shadowing + masking, MICROFACET_GRAZING);
}

// Normal of the facets that reflect the light into the eye: the direction halfway between the two.
// Returns: unit direction of toward_light + toward_eye. The result is shorter if the length of that
//   sum is below 1e-15. It is 0 for exactly opposite directions, so that its cosine with either is
//   0, as it is for nearly opposite directions.
// Units: none; unit vectors.
// Domain: |toward_light| = |toward_eye| = 1.
// Outside: the direction of the sum, for lengths up to 1e18.
// Accuracy: lavapipe 6 ulp; portable 21 ulp
fn microfacet_half(toward_light: vec3f, toward_eye: vec3f) -> vec3f {
    let sum = toward_light + toward_eye;
    return sum / sqrt(max(dot(sum, sum), MICROFACET_OPPOSITE));
}

// A facet that the eye sees, at random: of the unit square of u and turns, each part stands for as many as it has area.
// Stretched by 1 / alpha the facets are those of a hemisphere, which reflects the eye's rays evenly into a cap. Its
// height above the surface plane is a product; as a difference it would be lost where eye and facet are grazing.
// Returns: unit normal, on the surface's side and the eye's.
// Units: none; alpha is a slope.
// Domain: unit vectors with normal . toward_eye at least 0; any alpha, clamped to [0.001, 1]; u in [0, 1), a
//   multiple of 2^-24, and less than 0 counts as 0; azimuth (cos, sin) of any angle, 2 pi turns. It turns about the
//   normal, from a direction that jumps where normal.z changes sign, as any must somewhere.
// Outside: finite; an eye below the surface sees the facets that turn towards it.
// Accuracy: lavapipe 20 ulp + 6 backward; portable 56 ulp + 12 backward
fn microfacet_facet(normal: vec3f, toward_eye: vec3f, alpha: f32, u: f32, azimuth: vec2f) -> vec3f {
    let a = clamp(alpha, MICROFACET_SMOOTHEST, 1.0f);
    let height = dot(normal, toward_eye);
    let along = a * (toward_eye - height * normal);
    let inverse = 1.0f / sqrt(dot(along, along) + height * height);
    let cosine = inverse * height;
    let sine_squared = inverse * inverse * dot(along, along);
    // Height of the facet, times the length of the sum of two unit vectors: towards the eye, and of the cap.
    let v = max(u, 0.0f);
    let rise = (1.0f - v) * (1.0f + cosine);
    let sine = sqrt(v * ((1.0f + cosine) * rise + sine_squared));
    // The cap's direction along the surface: that in the plane z = 0, turned by half a turn about the middle of the
    // normal and the z axis.
    let middle = normal + vec3f(0.0f, 0.0f, select(1.0f, -1.0f, normal.z < 0.0f));
    let level = sine * azimuth;
    let turned = dot(middle.xy, level) / (1.0f + abs(normal.z)) * middle - vec3f(level, 0.0f);
    let facet = a * (inverse * along + turned) + rise * normal;
    return facet / sqrt(max(dot(facet, facet), MICROFACET_OPPOSITE));
}

// Share of a light's irradiance, measured perpendicular to its direction, that the rough surface reflects into
// the eye: BRDF times n . l. The product with that irradiance adds to the diffuse light of the body below.
// Returns: D F G2 / (4 n.l n.v) n.l in [0, fresnel / (2 pi alpha^3)]; 0 if the light is below the surface or
//   the normal is 0.
// Units: 1/sr; alpha is a slope, fresnel a share of light.
// Domain: unit vectors, and the normal may also be 0; any alpha, clamped to [0.001, 1]; fresnel in [0, 1],
//   evaluated at the cosine between half and light. An eye below the surface counts as grazing.
// Outside: for vectors of other lengths finite, but no reflectance; proportional to fresnel.
// Accuracy: lavapipe 45 ulp + 4 backward; portable 105 ulp + 8 backward
fn microfacet_reflectance(normal: vec3f, toward_light: vec3f, toward_eye: vec3f, alpha: f32, fresnel: f32) -> f32 {
    let half = microfacet_half(toward_light, toward_eye);
    let cosine_light = max(dot(normal, toward_light), 0.0f);
    let visibility = microfacet_visibility(cosine_light, dot(normal, toward_eye), alpha);
    return fresnel * microfacet_distribution(normal, half, alpha) * visibility * cosine_light;
}
