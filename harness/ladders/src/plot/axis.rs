//! An axis: its ends, its labelled values, and where a value stands. Labels never touch, also if a page's script moves
//! the ends of a logarithmic one.

/// An axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// What is shown, with its unit.
    pub label: String,
    /// The limits of a linear axis; `None` for a logarithmic one that has room for all points.
    pub linear: Option<(f64, f64)>,
    /// The labelled values; empty for round numbers.
    pub ticks: Vec<f64>,
    /// A value with a line across the plot, and what the line says.
    pub limit: Option<(f64, &'static str)>,
}

impl Axis {
    /// Returns a logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// Returns a linear axis.
    #[must_use]
    pub fn linear(label: &str, limits: (f64, f64)) -> Self {
        Self { linear: Some(limits), ..Self::log(label) }
    }

    /// Returns the axis with labels at these values.
    #[must_use]
    pub fn with_ticks(self, ticks: impl Into<Vec<f64>>) -> Self {
        Self { ticks: ticks.into(), ..self }
    }

    /// Whether the axis can show a value: a logarithmic one shows numbers above 0.
    pub(super) fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.linear.is_some() || value > 0.0)
    }

    /// Returns the axis laid out between two pixels, with room for values that it can show.
    pub(super) fn scale(&self, values: impl Iterator<Item = f64>, pixels: [f64; 2], room: Room) -> Scale {
        let length = (pixels[1] - pixels[0]).abs();
        if let Some((low, high)) = self.linear {
            let step = linear_step(high - low, length, room);
            let decimals = (-step.log10().floor()).max(0.0) as usize;
            let count = ((high - low) / step + 1e-9).floor() as u32;
            let values = (0..=count).map(|index| low + f64::from(index) * step);
            let tick = |value: f64| Tick { value, text: format!("{value:.decimals$}"), decades: f64::INFINITY };
            return Scale { ends: [low, high], pixels, is_log: false, further: values.map(tick).collect() };
        }
        let (low, high) = values.fold((f64::INFINITY, 0.0), |(low, high), value| (value.min(low), value.max(high)));
        let (low, high) = if low <= high { (low, high) } else { (1.0, 10.0) };
        let margin = 10f64.powf(MARGIN);
        let ends = [low / margin, high * margin];
        let candidates = match self.ticks.as_slice() {
            [] => candidates(ends[0].min(WIDEST[0]), ends[1].max(WIDEST[1]), room.labels(length)),
            given => given.iter().map(|value| (*value, f64::INFINITY)).collect(),
        };
        Scale { ends, pixels, is_log: true, further: apart(candidates, length, room) }
    }
}

/// The room of an axis's labels, which are texts of 14 pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Room {
    /// They stand side by side.
    Across,
    /// They stand one above the other.
    Up,
}

impl Room {
    /// Returns about how many labels an axis has on which more than powers of ten fit.
    fn labels(self, length: f64) -> f64 {
        let distance = match self {
            Self::Across => 100.0,
            Self::Up => 50.0,
        };
        (length / distance).max(9.0)
    }

    /// Returns how far apart the middles of two labels are at least.
    fn between(self, a: &str, b: &str) -> f64 {
        /// Width of a digit, the room beside a label, and the distance of lines.
        const DIGIT: f64 = 8.5;
        const GAP: f64 = 6.0;
        const LINE: f64 = 18.0;
        match self {
            Self::Across => 0.5 * DIGIT * (a.len() + b.len()) as f64 + GAP,
            Self::Up => LINE,
        }
    }
}

/// A labelled value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub value: f64,
    pub text: String,
    /// The powers of ten between the ends of the axis up to which the label has room.
    pub decades: f64,
}

/// An axis between two pixels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scale {
    /// The values at its ends.
    pub ends: [f64; 2],
    /// The pixels of its ends.
    pub pixels: [f64; 2],
    is_log: bool,
    /// The values that may be labelled, also beyond the ends, by size.
    further: Vec<Tick>,
}

impl Scale {
    /// Returns the pixel of a value.
    pub fn at(&self, value: f64) -> f64 {
        let place = |value: f64| if self.is_log { value.ln() } else { value };
        let [low, high] = self.ends.map(place);
        let [start, end] = self.pixels;
        start + (place(value) - low) / (high - low) * (end - start)
    }

    /// Whether a value is between the ends.
    pub fn holds(&self, value: f64) -> bool {
        let [low, high] = self.ends;
        let slack = 1e-9 * (high - low);
        (low - slack..=high + slack).contains(&value)
    }

    /// Returns the labelled values.
    pub fn ticks(&self) -> impl Iterator<Item = &Tick> {
        let decades = self.decades();
        self.further.iter().filter(move |tick| self.holds(tick.value) && decades <= tick.decades)
    }

    /// Returns the values that are labelled if the ends move apart: each text, a colon, and the powers of ten between
    /// the ends up to which it has room.
    pub fn growing(&self) -> String {
        let decades = self.decades();
        let remain = self.further.iter().filter(|tick| decades <= tick.decades);
        let shown = remain.map(|tick| format!("{}:{}", tick.text, (100.0 * tick.decades.min(99.0)).floor() / 100.0));
        shown.collect::<Vec<_>>().join(" ")
    }

    /// Returns the powers of ten between the ends; a linear axis has none.
    fn decades(&self) -> f64 {
        let [low, high] = self.ends;
        if self.is_log { (high / low).log10() } else { 0.0 }
    }
}

/// Room beyond the outermost points of a logarithmic axis, in powers of ten.
const MARGIN: f64 = 0.09;
/// The ends to which the axis of a page may grow.
const WIDEST: [f64; 2] = [1e-3, 1e6];

/// Returns the step of a linear axis: 1, 2 or 5 times a power of ten, ten steps or so, and room for labels.
fn linear_step(span: f64, length: f64, room: Room) -> f64 {
    let rough = (span / 10.0).max(span * room.between("0000", "0000") / length);
    let power = 10f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0].map(|part| part * power).into_iter().find(|step| *step >= rough).unwrap_or(10.0 * power)
}

/// Returns round values of a logarithmic axis, the more important first, each with the powers of ten between the ends
/// up to which there are at most about so many like it.
fn candidates(low: f64, high: f64, labels: f64) -> Vec<(f64, f64)> {
    // In tenths. Each list has what the one before has, and more.
    const FINE: &[u32] = &[10, 12, 14, 16, 18, 20, 25, 30, 35, 40, 45, 50, 60, 70, 80, 90];
    const STEPS: [&[u32]; 3] = [&[10, 20, 50], &[10, 20, 30, 40, 50, 60, 80], FINE];
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    // Parsed, because a power of ten is not always the nearest number to its digits.
    let value = |part: u32, power: i32| format!("{part}e{}", power - 1).parse().unwrap_or(f64::NAN);
    let mut tens: Vec<i32> = powers.clone().collect();
    // Of many powers of ten every second is left, then every fourth.
    tens.sort_by_key(|power| (std::cmp::Reverse(power.trailing_zeros()), *power));
    let mut found: Vec<(f64, f64)> = tens.into_iter().map(|power| (value(10, power), f64::INFINITY)).collect();
    let mut before: &[u32] = &[10];
    for parts in STEPS {
        let decades = labels / parts.len() as f64;
        let new = parts.iter().filter(|part| !before.contains(part));
        found.extend(new.flat_map(|part| powers.clone().map(move |power| (value(*part, power), decades))));
        before = parts;
    }
    found
}

/// Returns labels for values, each with the powers of ten between the ends up to which it has room beside those that
/// come before it; by size.
fn apart(candidates: Vec<(f64, f64)>, length: f64, room: Room) -> Vec<Tick> {
    let mut found: Vec<Tick> = Vec::new();
    for (value, decades) in candidates {
        let text = short(value);
        let touching = found.iter().filter_map(|other| {
            let touching = (other.value / value).log10().abs() * length / room.between(&text, &other.text);
            // One that is left out before it comes near is in nobody's way.
            (touching < other.decades).then_some(touching)
        });
        let decades = touching.fold(decades, f64::min);
        found.push(Tick { value, text, decades });
    }
    found.sort_by(|a, b| a.value.total_cmp(&b.value));
    found
}

/// Shows a value of a logarithmic axis.
fn short(value: f64) -> String {
    if (1e-3..1e6).contains(&value) { value.to_string() } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis, values: [f64; 2]) -> Vec<String> {
        let scale = axis.scale(values.into_iter(), [0.0, 900.0], Room::Across);
        scale.ticks().map(|tick| tick.text.clone()).collect()
    }

    #[test]
    fn the_ends_are_at_the_ends_and_every_value_between_them() {
        let scale = Axis::log("").scale([0.5, 50.0, 5.0].into_iter(), [100.0, 900.0], Room::Across);
        let [low, high] = scale.ends;
        assert!((scale.at(low) - 100.0).abs() < 1e-9 && (scale.at(high) - 900.0).abs() < 1e-9);
        assert!((scale.at(5.0) - 500.0).abs() < 1e-9, "the geometric mean is in the middle: {}", scale.at(5.0));
        let down = Scale { pixels: [400.0, 20.0], ..scale };
        assert!(down.at(0.5) > down.at(50.0), "up is a smaller pixel");
    }

    #[test]
    fn labels_are_round_and_few() {
        let log = Axis::log("");
        assert_eq!(texts(&log, [0.11, 0.18]), ["0.09", "0.1", "0.12", "0.14", "0.16", "0.18", "0.2"]);
        assert_eq!(texts(&log, [0.2, 0.75]), ["0.2", "0.3", "0.4", "0.5", "0.6", "0.8"]);
        assert_eq!(texts(&log, [0.7, 159.0]), ["1", "2", "5", "10", "20", "50", "100"]);
        assert_eq!(texts(&log, [1e-4, 30.0]), ["1e-4", "0.001", "0.01", "0.1", "1", "10"]);
        assert_eq!(texts(&Axis::log("").with_ticks([16.0, 32.0, 512.0]), [16.0, 256.0]), ["16", "32"]);
        let nothing = log.scale(std::iter::empty(), [0.0, 900.0], Room::Across);
        assert!(nothing.ticks().count() >= 2, "an axis of nothing is an axis");
        let linear = texts(&Axis::linear("", (0.0, 0.9)), [0.0; 2]);
        assert_eq!((linear.len(), linear[9].as_str()), (10, "0.9"));
    }

    #[test]
    fn labels_do_not_touch_however_far_the_axis_grows() {
        for (length, room) in [(888.0, Room::Across), (330.0, Room::Across), (90.0, Room::Across), (368.0, Room::Up)] {
            let start = Axis::log("").scale([4.0, 9.0].into_iter(), [0.0, length], room);
            for grown in 0..60 {
                let factor = 10f64.powf(f64::from(grown) / 10.0);
                let scale = Scale { ends: [start.ends[0] / factor.sqrt(), start.ends[1] * factor], ..start.clone() };
                let ticks: Vec<&Tick> = scale.ticks().collect();
                assert!(ticks.len() <= 12, "{ticks:?}");
                for pair in ticks.windows(2) {
                    let distance = scale.at(pair[1].value) - scale.at(pair[0].value);
                    assert!(distance >= room.between(&pair[0].text, &pair[1].text), "{length} {factor}: {pair:?}");
                }
            }
        }
    }

    #[test]
    fn what_grows_names_the_labels_that_remain() {
        let scale = Axis::log("").scale([0.7, 159.0].into_iter(), [0.0, 888.0], Room::Across);
        let growing = scale.growing();
        let growth_of = |text: &str| growing.split(' ').find_map(|tick| tick.strip_prefix(&format!("{text}:")));
        assert_eq!((growth_of("0.002"), growth_of("3"), growth_of("1")), (Some("3"), None, Some("99")));
        assert!(growth_of("100000").is_some());
        let listed = scale.ticks().all(|tick| growth_of(&tick.text).is_some());
        assert!(listed, "{growing}");
    }
}
