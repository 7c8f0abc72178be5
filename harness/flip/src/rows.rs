//! Pictures, filtered: first along the rows, then, a row at a time, down the columns.

use crate::color::{linear_values, luminance, opponent, perceived_of_opponent};
use crate::filter::{Features, Plane, Sensitivity, filter_row, pad};

/// A picture's opponent colours and features, filtered along the rows.
pub(crate) struct Rows {
    achromatic: Plane,
    red_green: Plane,
    blue_yellow: [Plane; 2],
    smooth: Plane,
    edge: Plane,
    point: Plane,
}

impl Rows {
    pub(crate) fn new(picture: &[u8], width: usize, sensitivity: &Sensitivity, features: &Features) -> Self {
        let linear = linear_values();
        let height = picture.len() / (3 * width);
        let plane = || Plane::new(width, height);
        let mut rows = Self {
            achromatic: plane(),
            red_green: plane(),
            blue_yellow: [plane(), plane()],
            smooth: plane(),
            edge: plane(),
            point: plane(),
        };
        let (mut colors, mut padded) = (Vec::new(), Vec::new());
        for (y, row) in picture.chunks_exact(3 * width).enumerate() {
            colors.clear();
            let light = |code: &u8| linear[usize::from(*code)];
            colors.extend(row.chunks_exact(3).map(|c| opponent([light(&c[0]), light(&c[1]), light(&c[2])])));
            let channel = |channel: usize| colors.iter().map(move |color| color[channel]);
            pad(channel(0), sensitivity.radius(), &mut padded);
            filter_row(&padded, &sensitivity.achromatic, rows.achromatic.row_mut(y));
            pad(channel(1), sensitivity.radius(), &mut padded);
            filter_row(&padded, &sensitivity.red_green, rows.red_green.row_mut(y));
            pad(channel(2), sensitivity.radius(), &mut padded);
            for (kernel, plane) in sensitivity.blue_yellow.iter().zip(&mut rows.blue_yellow) {
                filter_row(&padded, kernel, plane.row_mut(y));
            }
            pad(channel(0).map(luminance), features.radius(), &mut padded);
            filter_row(&padded, &features.gaussian, rows.smooth.row_mut(y));
            filter_row(&padded, &features.edge, rows.edge.row_mut(y));
            filter_row(&padded, &features.point, rows.point.row_mut(y));
        }
        rows
    }

    /// Filters down the columns, which completes the row `y`.
    pub(crate) fn filter_columns(&self, y: usize, sensitivity: &Sensitivity, features: &Features, row: &mut Row) {
        self.achromatic.filter_column(y, &sensitivity.achromatic, &mut row.achromatic);
        self.red_green.filter_column(y, &sensitivity.red_green, &mut row.red_green);
        for k in 0..2 {
            self.blue_yellow[k].filter_column(y, &sensitivity.blue_yellow[k], &mut row.blue_yellow[k]);
        }
        self.edge.filter_column(y, &features.gaussian, &mut row.edge[0]);
        self.smooth.filter_column(y, &features.edge, &mut row.edge[1]);
        self.point.filter_column(y, &features.gaussian, &mut row.point[0]);
        self.smooth.filter_column(y, &features.point, &mut row.point[1]);
    }
}

/// One row of a picture, filtered in both directions.
pub(crate) struct Row {
    achromatic: Vec<f32>,
    red_green: Vec<f32>,
    /// The two Gaussians, to be added.
    blue_yellow: [Vec<f32>; 2],
    /// First derivatives along x and y.
    edge: [Vec<f32>; 2],
    /// Second derivatives along x and y.
    point: [Vec<f32>; 2],
}

impl Row {
    pub(crate) fn new(width: usize) -> Self {
        let values = || vec![0.0; width];
        let pair = || [values(), values()];
        Self { achromatic: values(), red_green: values(), blue_yellow: pair(), edge: pair(), point: pair() }
    }

    pub(crate) fn color(&self, x: usize) -> [f32; 3] {
        let blue_yellow = self.blue_yellow[0][x] + self.blue_yellow[1][x];
        perceived_of_opponent([self.achromatic[x], self.red_green[x], blue_yellow])
    }

    /// Returns how much of an edge and how much of a point there is, in all directions together.
    pub(crate) fn features(&self, x: usize) -> [f32; 2] {
        [&self.edge, &self.point].map(|[along_x, along_y]| {
            let (dx, dy) = (along_x[x], along_y[x]);
            (dx * dx + dy * dy).sqrt()
        })
    }
}
