//! Machines to run on: one that rounds to nearest, one that notes every decision, one that errs as far as it may.

/// Where a decision is made: a function of the module and an expression of it, by their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Site {
    /// Which function.
    pub function: u32,
    /// Which expression of it.
    pub expression: u32,
}

/// What was decided where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// Where.
    pub site: Site,
    /// A condition as 0 or 1, the operand that a minimum took, the whole number that a floor gave.
    pub choice: u32,
}

/// How far WGSL lets the result of an operation be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slack {
    /// Correctly rounded, up or down.
    Rounded,
    /// So many units in the last place.
    Ulps(f64),
    /// So much.
    Absolute(f64),
    /// As 1 / inverseSqrt: 2 ulp, then a division's 2.5.
    Root,
}

/// What rounds, and what is told of decisions.
pub trait Machine {
    /// The result of an operation whose exact one is `exact`.
    fn round(&mut self, exact: f64, slack: Slack) -> f32;

    /// A branch was taken.
    fn decided(&mut self, _site: Site, _choice: u32) {}
}

/// Rounds to nearest, as the mirrors do.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nearest;

impl Machine for Nearest {
    fn round(&mut self, exact: f64, _: Slack) -> f32 {
        exact as f32
    }
}

/// Rounds to nearest and notes every decision.
#[derive(Clone, Debug, Default)]
pub struct Traced {
    /// What was decided, in order.
    pub decisions: Vec<Decision>,
}

impl Machine for Traced {
    fn round(&mut self, exact: f64, _: Slack) -> f32 {
        exact as f32
    }

    fn decided(&mut self, site: Site, choice: u32) {
        self.decisions.push(Decision { site, choice });
    }
}

/// Errs in every operation by a share of what WGSL allows: from -1, all of it downwards, to 1.
#[derive(Clone, Debug)]
pub struct Slacking {
    directions: Vec<f64>,
    at: usize,
}

impl Slacking {
    /// With these shares, operation by operation; the operations after them are rounded to nearest.
    pub fn new(directions: Vec<f64>) -> Self {
        Self { directions, at: 0 }
    }

    /// How many operations have been rounded.
    pub fn operations(&self) -> usize {
        self.at
    }
}

impl Machine for Slacking {
    fn round(&mut self, exact: f64, slack: Slack) -> f32 {
        let direction = self.directions.get(self.at).copied().unwrap_or(0.0);
        self.at += 1;
        let nearest = exact as f32;
        // What f32 holds is the result, where rounding is all that is allowed.
        if direction == 0.0 || !nearest.is_finite() {
            return nearest;
        }
        match slack {
            Slack::Rounded => rounded(exact, direction),
            // The units in the last place of 0 are subnormal: WGSL would let 0 / x be one, but no device is that odd.
            Slack::Ulps(_) if exact == 0.0 => nearest,
            Slack::Ulps(ulps) => within(exact, direction, ulps),
            Slack::Absolute(most) => (exact + direction * most) as f32,
            Slack::Root if exact == 0.0 => 0.0,
            Slack::Root => within(1.0 / f64::from(within(1.0 / exact, -direction, 2.0)), direction, 2.5),
        }
    }
}

/// The neighbour of an exact result on one side, or the result itself where f32 holds it.
fn rounded(exact: f64, direction: f64) -> f32 {
    let nearest = exact as f32;
    let off = exact - f64::from(nearest);
    if direction > 0.0 && off > 0.0 {
        nearest.next_up()
    } else if direction < 0.0 && off < 0.0 {
        nearest.next_down()
    } else {
        nearest
    }
}

/// The float farthest off within so many ulp.
fn within(exact: f64, direction: f64, ulps: f64) -> f32 {
    let reach = direction * ulps * crate::tolerance::ulp_of(exact.abs());
    let end = exact + reach;
    let found = end as f32;
    // Rounding may not carry it beyond.
    if (f64::from(found) - exact).abs() <= reach.abs() {
        found
    } else if f64::from(found) > end {
        found.next_down()
    } else {
        found.next_up()
    }
}
