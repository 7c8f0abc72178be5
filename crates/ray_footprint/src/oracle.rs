//! The truth in f64, by other ways than the mirror's.

use glam::{DVec2, DVec3, DVec4};

/// Distances from the eye's image: the offset grows as the way from there does.
pub fn growth(distance: f64, travelled: f64, relative_index: f64) -> f64 {
    let image = relative_index * distance;
    (image + travelled) / image
}

/// The difference of the distances to both planes, times both slopes, in the middle of the pixel and
/// a step to the right and down of it.
pub fn edge(direction: DVec3, right: DVec3, down: DVec3, nearest: DVec3, runner_up: DVec3, gap: f64) -> DVec3 {
    let (slope, other) = (direction.dot(nearest), direction.dot(runner_up));
    // How much farther the runner-up is, after a step.
    let step = |offset: DVec3| slope * offset.dot(runner_up) - other * offset.dot(nearest);
    DVec3::new(slope * other * gap, step(right), step(down))
}

/// The part of the pixel's outline beyond the line, cut off corner by corner, and its area.
pub fn share(edge: DVec3) -> f64 {
    let normal = DVec2::new(edge.y, edge.z);
    let size = normal.abs().max_element();
    if size == 0.0 {
        return 0.0;
    }
    let (normal, f) = (normal / size, edge.x.abs() / size);
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, y)| DVec2::new(x, y));
    let mut outline = Vec::new();
    for (place, from) in corners.into_iter().enumerate() {
        let to = corners[(place + 1) % 4];
        let (of_from, of_to) = (normal.dot(from) - f, normal.dot(to) - f);
        if of_from >= 0.0 {
            outline.push(from);
        }
        if (of_from > 0.0) != (of_to > 0.0) && of_from != of_to {
            outline.push(from.lerp(to, of_from / (of_from - of_to)));
        }
    }
    let area = |(place, from): (usize, &DVec2)| from.perp_dot(outline[(place + 1) % outline.len()]);
    0.5 * outline.iter().enumerate().map(area).sum::<f64>()
}

/// Each neighbour's height above the line, as its share of all.
pub fn neighbours(edge: DVec3, share: f64) -> DVec4 {
    let f = edge.x.max(0.0);
    let heights =
        [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].map(|(x, y)| (x * edge.y + y * edge.z - f).max(0.0));
    let sum: f64 = heights.iter().sum();
    if sum == 0.0 { DVec4::ZERO } else { DVec4::from_array(heights.map(|height| share * height / sum)) }
}

/// The pixel, moved towards each neighbour by its share of their difference.
pub fn mix(centre: DVec4, right: DVec4, left: DVec4, below: DVec4, above: DVec4, shares: DVec4) -> DVec4 {
    let neighbours = [right, left, below, above];
    centre + neighbours.into_iter().zip(shares.to_array()).map(|(other, share)| share * (other - centre)).sum::<DVec4>()
}
