//! Axes: where a number lies between the two ends of a plot, and which numbers are written beside it.

use std::ops::Range;

/// An axis with its title; every number has a place on it, whatever it is.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    /// What is measured, and its unit.
    pub(super) title: String,
    scale: Scale,
}

#[derive(Clone, Copy, Debug)]
enum Scale {
    /// From 0, so many steps of a round number.
    Linear { step: f64, steps: f64 },
    /// From one power of ten to another, and the first and the last round number between them. Where there are zeros they have
    /// a place of their own left of it.
    Log { ends: [f64; 2], start: Round, end: Round, ticks: Ticks, has_zero: bool },
}

/// Which round numbers are written beside a logarithmic axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ticks {
    All,
    /// There would be too many.
    Powers,
}

/// m · 10^exponent, m being 1, 2 or 5: numbers that people count in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Round {
    exponent: i32,
    /// 1, 2 or 5.
    mantissa: u8,
}

impl Axis {
    /// From 0 to a round number past the largest of some; what is infinite or no number does not count.
    pub(crate) fn linear(title: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        let largest = values.into_iter().filter(|value| value.is_finite()).fold(0.0, f64::max);
        let largest = if largest > 0.0 { largest.clamp(LEAST, LARGEST) } else { 1.0 };
        // Marks do not sit on the frame.
        const MARGIN: f64 = 1.02;
        let step = Round::from_above(MARGIN * largest / 7.0).value();
        let steps = (MARGIN * largest / step).ceil();
        Self { title: title.into(), scale: Scale::Linear { step, steps } }
    }

    /// Around all of some numbers, in powers of ten, from a round one to another. Zeros stand apart, left of a break; what is
    /// infinite does not count.
    pub(crate) fn log(title: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        // Marks do not sit on the frame.
        const MARGIN: f64 = 1.3;
        let (least, largest, has_zero) = Self::positive(values, MARGIN);
        Self { title: title.into(), scale: Scale::around(least, largest, has_zero) }
    }

    /// The same, but it ends close to the numbers if there are two round ones or more between them: for small plots.
    pub(crate) fn close_log(title: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        const MARGIN: f64 = 1.15;
        let (least, largest, has_zero) = Self::positive(values, MARGIN);
        let (start, end) = (Round::from_above(least), Round::from_below(largest));
        let scale = if start < end {
            let ends = [least.log10(), largest.log10()];
            let ticks = if end.exponent - start.exponent < 2 { Ticks::All } else { Ticks::Powers };
            Scale::Log { ends, start, end, ticks, has_zero }
        } else {
            Scale::around(least, largest, has_zero)
        };
        Self { title: title.into(), scale }
    }

    /// The least and the largest number above 0, with a margin around them, and whether there are zeros too.
    fn positive(values: impl IntoIterator<Item = f64>, margin: f64) -> (f64, f64, bool) {
        let (mut least, mut largest, mut has_zero) = (f64::INFINITY, 0.0, false);
        for value in values.into_iter().filter(|value| value.is_finite()) {
            if value > 0.0 {
                (least, largest) = (f64::min(least, value), f64::max(largest, value));
            } else {
                has_zero = true;
            }
        }
        if largest > 0.0 {
            (least.clamp(LEAST, LARGEST) / margin, largest.clamp(LEAST, LARGEST) * margin, has_zero)
        } else {
            (1.0, 10.0, has_zero)
        }
    }

    /// From 0 at one end to 1 at the other; a number beyond an end is at that end.
    pub(super) fn fraction(&self, value: f64) -> f64 {
        let fraction = match self.scale {
            Scale::Linear { step, steps } => value / step / steps,
            Scale::Log { has_zero: true, .. } if value <= 0.0 => ZERO_AT,
            Scale::Log { ends: [from, to], has_zero, .. } => {
                let first = if has_zero { BREAK_END } else { 0.0 };
                let along = (value.log10() - from) / (to - from);
                first + (1.0 - first) * along.clamp(0.0, 1.0)
            }
        };
        if fraction.is_finite() { fraction.clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Where the axis is broken between 0 and its first power of ten, as fractions.
    pub(super) fn broken_between(&self) -> Option<Range<f64>> {
        matches!(self.scale, Scale::Log { has_zero: true, .. }).then_some(BREAK_START..BREAK_END)
    }

    /// Numbers to write beside it, not too many, and how they are written: as 0.02, 50, or all as 10⁻⁶, 10⁻⁵.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        let numbers = self.numbers();
        let text = if numbers.iter().copied().all(is_plain) { plain } else { power };
        numbers.into_iter().map(|number| (number, text(number))).collect()
    }

    fn numbers(&self) -> Vec<f64> {
        const MOST: i32 = 9;
        match self.scale {
            Scale::Linear { step, steps } => {
                let counts = (0_u8..=u8::MAX).map(f64::from).take_while(|&count| count <= steps);
                counts.map(|count| count * step).collect()
            }
            Scale::Log { start, end, ticks, has_zero, .. } => {
                let decades = end.exponent - start.exponent;
                let every = (decades + MOST - 1) / MOST;
                let mut rounds = vec![];
                for exponent in start.exponent..=end.exponent {
                    let mantissas: &[u8] = if ticks == Ticks::Powers { &[1] } else { &[1, 2, 5] };
                    rounds.extend(mantissas.iter().map(|&mantissa| Round { exponent, mantissa }));
                }
                let is_tick = |round: &Round| {
                    (start..=end).contains(round) && round.exponent.rem_euclid(every.max(1)) == 0
                };
                let zero = has_zero.then_some(0.0);
                zero.into_iter().chain(rounds.into_iter().filter(is_tick).map(Round::value)).collect()
            }
        }
    }
}

impl Scale {
    /// From the round number below to the one above.
    fn around(least: f64, largest: f64, has_zero: bool) -> Self {
        let (start, end) = (Round::from_below(least), Round::from_above(largest));
        let ticks = if end.exponent - start.exponent <= 2 { Ticks::All } else { Ticks::Powers };
        Self::Log { ends: [start.log10(), end.log10()], start, end, ticks, has_zero }
    }
}

/// Numbers beyond these are at the end of an axis.
const LEAST: f64 = 1e-290;
const LARGEST: f64 = 1e290;

/// Where the zeros of a logarithmic axis stand, as a fraction of it.
const ZERO_AT: f64 = 0.05;
/// Where the axis ends behind them,
const BREAK_START: f64 = 0.1;
/// and where it goes on.
const BREAK_END: f64 = 0.12;

impl Round {
    /// The largest one that is no larger.
    fn from_below(value: f64) -> Self {
        let exponent = decade(value);
        let fits = |&mantissa: &u8| Self { exponent, mantissa }.value() <= value;
        let mantissa = [5, 2, 1].into_iter().find(fits);
        mantissa.map_or(Self { exponent: exponent - 1, mantissa: 5 }, |mantissa| Self { exponent, mantissa })
    }

    /// The smallest one that is no smaller.
    fn from_above(value: f64) -> Self {
        let exponent = decade(value);
        let fits = |&mantissa: &u8| Self { exponent, mantissa }.value() >= value;
        let mantissa = [1, 2, 5].into_iter().find(fits);
        mantissa.map_or(Self { exponent: exponent + 1, mantissa: 1 }, |mantissa| Self { exponent, mantissa })
    }

    fn value(self) -> f64 {
        // The decimal text is the nearest number to it, which repeated multiplication is not.
        format!("{}e{}", self.mantissa, self.exponent).parse().unwrap_or(1.0)
    }

    fn log10(self) -> f64 {
        f64::from(self.exponent) + f64::from(self.mantissa).log10()
    }
}

/// The power of ten at or below a number > 0.
fn decade(value: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "within ±324")]
    let exponent = value.log10().floor() as i32;
    exponent.clamp(-300, 300)
}

/// A number from 0.001 to 99999, without digits that say nothing.
fn plain(value: f64) -> String {
    // Steps are multiples of round numbers, which are off by an ulp at times.
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn is_plain(value: f64) -> bool {
    value == 0.0 || (0.999e-3..1e5).contains(&value)
}

/// A round number as a power of ten: 10⁻⁶, 2·10⁻⁶.
fn power(value: f64) -> String {
    if value == 0.0 || value == 1.0 {
        return plain(value);
    }
    let exponent = decade(value * 1.000_001);
    let power = superscript(exponent);
    let mantissa = plain(value / Round { exponent, mantissa: 1 }.value());
    if mantissa == "1" { format!("10{power}") } else { format!("{mantissa}·10{power}") }
}

fn superscript(number: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |digit: char| digit.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    number.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn texts(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_numbers_that_people_count_in() {
        assert_eq!(texts(&Axis::linear("", [11.7])), ["0", "2", "4", "6", "8", "10", "12"]);
        assert_eq!(texts(&Axis::linear("", [0.07])), ["0", "0.02", "0.04", "0.06", "0.08"]);
        assert_eq!(texts(&Axis::log("", [0.4, 20.0])), ["0.2", "0.5", "1", "2", "5", "10", "20", "50"]);
        assert_eq!(texts(&Axis::log("", [2e-6, 0.2])), ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"]);
        assert_eq!(texts(&Axis::log("", [3e-7, 9e-7])), ["2·10⁻⁷", "5·10⁻⁷", "10⁻⁶", "2·10⁻⁶"]);
        assert_eq!(
            texts(&Axis::linear("", [3e6])),
            ["0", "5·10⁵", "10⁶", "1.5·10⁶", "2·10⁶", "2.5·10⁶", "3·10⁶", "3.5·10⁶"]
        );
    }

    #[test]
    fn a_close_axis_ends_by_its_numbers_and_has_ticks_all_the_same() {
        let close = Axis::close_log("", [1.0, 17.0]);
        assert_eq!(texts(&close), ["1", "2", "5", "10"]);
        assert!(close.fraction(1.0) < 0.06 && close.fraction(17.0) > 0.94, "{close:?}");
        assert_eq!(texts(&Axis::close_log("", [256.0, 16384.0])), ["1000", "10000"]);
        assert_eq!(texts(&Axis::close_log("", [1e3, 1e6])), ["10³", "10⁴", "10⁵", "10⁶"]);
        assert_eq!(texts(&Axis::close_log("", [300.0])), ["200", "500"]);
        assert_eq!(texts(&Axis::close_log("", [1.0])), ["0.5", "1", "2"]);
    }

    #[test]
    fn zero_stands_apart_on_a_logarithmic_axis() {
        let axis = Axis::log("", [0.0, 1e-6, 1e-2]);
        let broken = axis.broken_between().unwrap();
        assert!(axis.fraction(0.0) < broken.start && axis.fraction(1e-6) > broken.end);
        assert_eq!(texts(&axis)[0], "0");
        assert_eq!(Axis::log("", [1e-6, 1e-2]).broken_between(), None);
    }

    #[test]
    fn an_axis_without_numbers_still_has_ends() {
        for axis in [
            Axis::linear("", []),
            Axis::linear("", [f64::NAN]),
            Axis::log("", []),
            Axis::log("", [0.0]),
            Axis::close_log("", []),
        ] {
            assert!(axis.ticks().len() >= 2, "{axis:?}");
            assert_eq!(axis.fraction(f64::INFINITY).clamp(0.0, 1.0), axis.fraction(f64::INFINITY));
        }
    }

    proptest! {
        #[test]
        fn every_number_has_a_place_and_larger_ones_lie_further(
            mut values in prop::collection::vec(any::<f64>().prop_map(f64::abs), 1..6)
        ) {
            values.sort_by(f64::total_cmp);
            let [linear, log] = [Axis::linear("", values.clone()), Axis::log("", values.clone())];
            for axis in [linear, log, Axis::close_log("", values.clone())] {
                let finite = values.iter().filter(|value| value.is_finite());
                let places: Vec<f64> = finite.map(|&value| axis.fraction(value)).collect();
                prop_assert!(places.iter().all(|place| (0.0..=1.0).contains(place)), "{places:?}");
                prop_assert!(places.is_sorted(), "{places:?} on {axis:?}");
                let ticks = axis.ticks();
                prop_assert!((1..=12).contains(&ticks.len()) && ticks.iter().all(|(tick, _)| tick.is_finite()), "{ticks:?}");
            }
        }
    }
}
