//! Draws the failure map: every test is a mark at the values of two parameters, as in the paper's Figure 9.

use super::DrawResult;
use super::drawn::{MOST_MARKS, is_drawn};
use super::mark::{Drawn, Mark, ORDER};
use super::wrapped::wrapped;
use super::{GRID, HPos, INK, Tints, ink, level, shade};
use paracosm_analysis::Effects;
use paracosm_analysis::blame::Blame;
use paracosm_analysis::failure_estimate;
use paracosm_analysis::failure_estimate::{Axes, AxesFlaw, FailureEstimate};
use paracosm_campaign::{Error, Log, Trial};
use paracosm_oracles::Verdict;
use paracosm_space::plural;
use paracosm_space::{Coordinate, Domain};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::*;
use std::ops::Range;

/// The label and the range of a linear axis of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The name of the quantity along the axis, with the unit.
    pub label: String,
    /// The least and the greatest value of the axis.
    pub range: (f64, f64),
}

impl Axis {
    /// Returns the axis of a continuous coordinate; `None` for a discrete coordinate.
    pub fn of(coordinate: &Coordinate) -> Option<Self> {
        match coordinate.parameter.domain {
            Domain::Interval { lo, hi } => Some(Self { label: coordinate.label(), range: (lo, hi) }),
            Domain::Choice(_) => None,
        }
    }
}

/// A failure map, which shows the tests of a campaign as marks in a plane of two coordinates. Failing tests are red
/// crosses, passing tests are blue dots.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureMap {
    /// The title of the map, which is the first line.
    pub title: String,
    /// The note below the title of the map, in smaller letters and at most three lines.
    pub note: String,
    /// The names of the coordinates that vary between the tests but are not axes of the map.
    pub others: Vec<String>,
    /// The label and the range of the horizontal axis.
    pub x: Axis,
    /// The label and the range of the vertical axis.
    pub y: Axis,
    /// The tests on the map, each with its two coordinates and its mark.
    pub marks: Vec<(f64, f64, Mark)>,
    /// The estimated probability of failure behind the marks; `None` if the map does not show a probability.
    pub estimate: Option<FailureEstimate>,
    /// The numbers of the tests, which colour the tests' dots; `None` if the map does not show numbers.
    pub tints: Option<Tints>,
}

/// The width of the bar of shades with its numbers, as a multiple of the size of text.
const BAR: f64 = 5.4;

/// The size of the note, the distance of its lines, both as multiples of the size of text, and the greatest number of
/// lines. Text that does not fit can be read in the campaign's files.
const NOTE: f64 = 0.85;
const LINE: f64 = 1.2;
const NOTE_LINES: usize = 3;

impl FailureMap {
    /// Makes the failure map of a campaign over its first two continuous coordinates; `None` if the campaign has fewer
    /// continuous coordinates.
    pub fn of(log: &Log) -> Option<Self> {
        Self::at(log, [0, 1], |trial| Mark::Verdict(trial.verdict))
    }

    /// Makes the failure map of a campaign over two named continuous coordinates, with the estimated probability of
    /// failure.
    ///
    /// # Errors
    /// Returns an error if a name is not the name of a continuous coordinate, if both names are the same, or if a trial
    /// does not belong to the study's space.
    pub fn over(log: &Log, names: [&str; 2]) -> Result<Self, Error> {
        let axes = failure_estimate::axes(log.study(), names)?;
        let mark = |trial: &Trial| Mark::Verdict(trial.verdict);
        let map = Self::at(log, axes, mark).expect("there are coordinates of these names");
        Ok(Self { estimate: FailureEstimate::of(log, axes)?, ..map })
    }

    /// Makes the map of the blame for the failures of a campaign, over two named continuous coordinates.
    ///
    /// # Errors
    /// Returns an error if a name is not the name of a continuous coordinate, or if both names are the same.
    pub fn of_blame(log: &Log, blame: &Blame, names: [&str; 2]) -> Result<Self, AxesFlaw> {
        let axes = failure_estimate::axes(log.study(), names)?;
        let mark = |trial: &Trial| match blame.of(trial.index) {
            Some(blamed) => Mark::Fault(blamed.fault),
            None => Mark::Verdict(trial.verdict),
        };
        let mut map = Self::at(log, axes, mark).expect("there are coordinates of these names");
        map.note = format!("{}, failures judged by {}", map.note, blame.references.join(", "));
        Ok(map)
    }

    /// Makes the map of the impact speeds of a campaign, over two named continuous coordinates. The colour of a test is the speed of the
    /// ego vehicle at its first contact, and 0 m/s without a contact. Tests with the verdict `error` or `invalid` are left out.
    ///
    /// # Errors
    /// Returns an error if a name is not the name of a continuous coordinate, or if both names are the same.
    pub fn of_severity(log: &Log, names: [&str; 2]) -> Result<Self, AxesFlaw> {
        let axes = failure_estimate::axes(log.study(), names)?;
        // The severity of a test that broke is not known.
        let log = &log.with_trials(log.trials().iter().filter(|trial| trial.covers()).cloned().collect());
        let mark = |trial: &Trial| Mark::Verdict(trial.verdict);
        let map = Self::at(log, axes, mark).expect("there are coordinates of these names");
        let speed = |trial: &Trial| trial.contact().map_or(0.0, |contact| contact.speed);
        let values: Vec<f64> = log.trials().iter().map(speed).collect();
        let most = values.iter().copied().fold(1.0, f64::max).ceil();
        let tints = Tints { label: "impact speed (m/s)".to_owned(), range: (0.0, most), values };
        Ok(Self { tints: Some(tints), ..map })
    }

    /// Adds the open parameters that changed no trace to the note of the map.
    #[must_use]
    pub fn noting(mut self, effects: &Effects) -> Self {
        let names: Vec<&str> = effects.without_effect().map(|(name, _)| name).collect();
        if !names.is_empty() {
            self.note = format!("{}; no effect: {}", self.note, names.join(", "));
        }
        self
    }

    fn at(log: &Log, axes: Axes, mark: impl Fn(&Trial) -> Mark) -> Option<Self> {
        let (study, trials) = (log.study(), log.trials());
        let continuous: Vec<Coordinate> = study.space().continuous().collect();
        let [x, y] = axes.map(|axis| continuous.get(axis).copied());
        let (x, y) = (x?, y?);
        let at = |trial: &Trial, c: &Coordinate| c.value(trial.test.get(&c.parameter.name)?)?.number();
        let mark = |trial: &Trial| Some((at(trial, &x)?, at(trial, &y)?, mark(trial)));
        Some(Self {
            title: study.title(),
            note: format!("{}, strategy {}", plural(trials.len(), "test"), study.sampling()),
            others: study.space().coordinates().filter(|c| ![x, y].contains(c)).map(|c| c.name()).collect(),
            x: Axis::of(&x)?,
            y: Axis::of(&y)?,
            marks: trials.iter().filter_map(mark).collect(),
            estimate: None,
            tints: None,
        })
    }

    /// Returns the number of tests with a mark.
    fn count(&self, mark: Mark) -> usize {
        self.marks.iter().filter(|other| other.2 == mark).count()
    }

    /// Returns the lines of text below the title of the map. The text names the contents of the map, and the
    /// coordinates that vary although the map does not show them.
    fn note(&self) -> String {
        let others = self.others.join(", ");
        let is_thinned = ORDER.into_iter().any(|mark| self.count(mark) > MOST_MARKS);
        let drawn = if is_thinned { format!("; about {MOST_MARKS} marks of a kind are drawn") } else { String::new() };
        match (self.others.is_empty(), &self.estimate) {
            (true, _) => format!("{}{drawn}", self.note),
            (false, None) => format!("{}{drawn}; other open parameters, not shown: {others}", self.note),
            (false, Some(_)) => format!("{}{drawn}; averaged over the other open parameters: {others}", self.note),
        }
    }

    /// Draws the map over the whole area, every length in pixels times `scale`.
    pub(super) fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: f64) -> DrawResult<B> {
        let px = |length: f64| (length * scale).round() as u32;
        let small = area.dim_in_pixel().0 < px(600.0);
        let (text, side) = if small { (14.0, 2.2) } else { (18.0, 3.2) };
        let width = area.dim_in_pixel().0 as f64 - 1.6 * text * scale;
        let title = wrapped(area, &self.title, &ink(1.15 * text * scale), width, 1)?;
        let note = wrapped(area, &self.note(), &ink(NOTE * text * scale), width, NOTE_LINES)?;
        let more = LINE * (note.len() - 1) as f64;
        let (header, body) = area.split_vertically(px((5.0 + more) * text));
        self.draw_header(&header, [title, note], text * scale, side * scale, scale)?;
        let has_bar = self.estimate.is_some() || self.tints.is_some();
        let (body, bar) = if has_bar {
            let (body, bar) = body.split_horizontally(body.dim_in_pixel().0 - px(BAR * text));
            (body, Some(bar))
        } else {
            (body, None)
        };

        let mut chart = ChartBuilder::on(&body)
            .margin_right(px(1.6 * text))
            .margin_left(px(0.5 * text))
            .margin_bottom(px(0.5 * text))
            .x_label_area_size(px(2.8 * text))
            .y_label_area_size(px(3.6 * text))
            .build_cartesian_2d(Ends(self.x.range), Ends(self.y.range))?;
        if let Some(estimate) = &self.estimate {
            shade::draw_shades(&chart.plotting_area().strip_coord_spec(), estimate)?;
        }
        chart
            .configure_mesh()
            .x_desc(&self.x.label)
            .y_desc(&self.y.label)
            .axis_desc_style(ink(px(text).into()))
            .label_style(ink(px(text - 2.0).into()))
            .axis_style(INK.stroke_width(px(1.0)))
            .bold_line_style(GRID.stroke_width(px(1.0)))
            .light_line_style(TRANSPARENT)
            .x_labels(if small { 6 } else { 11 })
            .y_labels(if small { 7 } else { 12 })
            .draw()?;
        let along = (0, (body.dim_in_pixel().1 - px(3.3 * text)) as i32);
        // A thousand marks have room. If there are more, they become smaller, so that they do not run together.
        let drawn: usize = ORDER.into_iter().map(|mark| self.count(mark).min(MOST_MARKS)).sum();
        let crowd = (drawn as f64 / 1000.0).max(1.0);
        let side = (side / crowd.sqrt()).max(1.2) * scale;
        if let (Some(estimate), Some(bar)) = (&self.estimate, &bar) {
            shade::draw_lines(&chart.plotting_area().strip_coord_spec(), estimate, scale)?;
            shade::draw_bar(bar, along, text * scale)?;
        } else if let (Some(tints), Some(bar)) = (&self.tints, &bar) {
            let dot = |((x, y, _), value): (&(f64, f64, Mark), &f64)| {
                Circle::new((*x, *y), 2.2 * side, tints.colour(*value).filled())
            };
            let dots = self.marks.iter().zip(&tints.values).enumerate();
            let dots = dots.filter(|(index, _)| is_drawn(*index, self.marks.len()));
            chart.draw_series(dots.map(|(_, tinted)| dot(tinted)))?;
            tints.draw_bar(bar, along, text * scale)?;
        }
        for mark in ORDER {
            // On a map with tints, a tinted dot without another mark is a passing test.
            let hidden = self.tints.is_some() && mark == Mark::Verdict(Verdict::Pass);
            let count = self.count(mark);
            let marks = self.marks.iter().filter(|other| other.2 == mark && !hidden).enumerate();
            let marks = marks.filter(|(index, _)| is_drawn(*index, count));
            chart.draw_series(marks.map(|(_, (x, y, _))| EmptyElement::at((*x, *y)) + Drawn { mark, side }))?;
        }
        Ok(())
    }

    /// Draws the title and the note of the map, and the legend with the number of tests for each mark.
    fn draw_header<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        [title, note]: [Vec<String>; 2],
        text: f64,
        side: f64,
        scale: f64,
    ) -> DrawResult<B> {
        let left = (0.8 * text) as i32;
        for line in title {
            area.draw(&Text::new(line, (left, (0.5 * text) as i32), ink(1.15 * text)))?;
        }
        let at = |line: usize, first: f64| ((first + LINE * line as f64) * text) as i32;
        let line = at(note.len() - 1, 3.8);
        for (i, line) in note.into_iter().enumerate() {
            area.draw(&Text::new(line, (left, at(i, 1.95)), ink(NOTE * text)))?;
        }
        let mut at = left + side as i32;
        let of_faults = self.marks.iter().any(|mark| matches!(mark.2, Mark::Fault(_)));
        for mark in ORDER.into_iter().rev() {
            let count = self.count(mark);
            if count == 0 && !mark.is_listed(of_faults) {
                continue;
            }
            area.draw(&(EmptyElement::at((at, line)) + Drawn { mark, side: 1.3 * side }))?;
            let label = format!("{mark} {count}");
            let style = level(0.9 * text, HPos::Left);
            let (width, _) = area.estimate_text_size(&label, &style)?;
            at += (0.8 * text) as i32;
            area.draw(&Text::new(label, (at, line), style))?;
            at += width as i32 + (1.8 * text) as i32;
        }
        match &self.estimate {
            Some(estimate) => shade::draw_key(area, estimate, (at, line), text, scale),
            None => Ok(()),
        }
    }
}

/// A range of an axis. The numbers along the axis include both ends, because readers of a map look for the ends first.
pub(super) struct Ends(pub (f64, f64));

impl Ranged for Ends {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        // Of halves, because the width of an interval may be beyond the largest number.
        let share = (value / 2.0 - self.0.0 / 2.0) / (self.0.1 / 2.0 - self.0.0 / 2.0);
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<H: KeyPointHint>(&self, hint: H) -> Vec<f64> {
        self.numbers(hint.max_num_points())
    }

    fn range(&self) -> Range<f64> {
        self.0.0..self.0.1
    }
}

impl Ends {
    /// Returns the numbers along the axis. They are both ends and round numbers between them, at most about `most`
    /// steps.
    pub(super) fn numbers(&self, most: usize) -> Vec<f64> {
        let (lo, hi) = self.0;
        let most = most.max(2) as f64;
        let step = round_step(hi / most - lo / most);
        let first = (lo / step).ceil() as i64;
        let last = (hi / step).floor() as i64;
        let inner = (first..=last).map(|i| i as f64 * step);
        // An inner number too close to an end would be printed over it.
        let clear = inner.filter(|x| x - lo > 0.4 * step && hi - x > 0.4 * step);
        [lo].into_iter().chain(clear).chain([hi]).collect()
    }
}

impl ValueFormatter<f64> for Ends {
    fn format(value: &f64) -> String {
        // Steps are round numbers, so that six digits hide only rounding errors.
        let short = |text: &str| text.trim_end_matches('0').trim_end_matches('.').to_owned();
        if *value == 0.0 || PLAIN.contains(&value.abs()) {
            return short(&format!("{value:.6}"));
        }
        let text = format!("{value:.6e}");
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        format!("{}e{power}", short(digits))
    }
}

/// The sizes of numbers that are written without a power of ten.
const PLAIN: Range<f64> = 1e-4..1e9;

/// Returns the least of 1, 2, 5, 10, 20, 50, ... and their tenths, hundredths and so on that is at least `width`.
pub(super) fn round_step(width: f64) -> f64 {
    let enough = (width * (1.0 - 1e-9)).max(f64::MIN_POSITIVE);
    let exponent = libm::floor(libm::log10(enough)) as i32;
    // Powers of ten from their texts are the nearest numbers.
    let power = |exponent: i32| format!("1e{exponent}").parse::<f64>().unwrap_or(f64::MAX);
    let steps =
        (exponent - 1..=exponent + 1).flat_map(|exponent| [1.0, 2.0, 5.0].map(|factor| factor * power(exponent)));
    steps.into_iter().find(|step| *step >= enough).unwrap_or(f64::MAX).min(f64::MAX)
}

#[cfg(test)]
mod tests {
    use super::super::Picture;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn an_axis_of_any_interval_has_a_few_rising_numbers(a in prop::num::f64::NORMAL, b in prop::num::f64::NORMAL) {
            prop_assume!(a < b);
            let numbers = Ends((a, b)).numbers(12);
            prop_assert!(numbers.len() <= 16, "{numbers:?}");
            prop_assert_eq!((numbers[0], numbers[numbers.len() - 1]), (a, b));
            prop_assert!(numbers.is_sorted(), "{numbers:?}");
            for number in numbers {
                prop_assert!(Ends::format(&number).len() <= 20);
                let place = Ends((a, b)).map(&number, (0, 1000));
                prop_assert!((0..=1000).contains(&place), "{number} {place}");
            }
        }
    }

    #[test]
    fn numbers_of_any_size_are_short() {
        for (number, text) in [(0.0, "0"), (12.5, "12.5"), (-0.001, "-0.001"), (1e18, "1e18"), (2.5e-7, "2.5e-7")] {
            assert_eq!(Ends::format(&number), text);
        }
        assert_eq!(round_step(0.3), 0.5);
        assert_eq!(round_step(1e17), 1e17);
        assert_eq!(round_step(1.1e-9), 2e-9);
    }

    #[test]
    fn a_map_of_many_tests_draws_all_rare_marks_and_some_of_the_others_and_counts_all() {
        let place = |i: u32| (f64::from(i % 251) / 251.0, f64::from(i) / 40_000.0);
        let mark = |i: u32| Mark::Verdict(if i.is_multiple_of(1000) { Verdict::Fail } else { Verdict::Pass });
        let axis = || Axis { label: "x".to_owned(), range: (0.0, 1.0) };
        let map = FailureMap {
            title: "many tests".to_owned(),
            note: "40000 tests".to_owned(),
            others: Vec::new(),
            x: axis(),
            y: axis(),
            marks: (0..40_000).map(|i| (place(i).0, place(i).1, mark(i))).collect(),
            estimate: None,
            tints: None,
        };
        let svg = Picture::of(map).svg().unwrap();
        assert!(svg.contains("about 10000 marks of a kind are drawn"));
        assert!(svg.contains("fail 40") && svg.contains("pass 39960"));
        let dots = svg.matches("<circle").count();
        assert!((9_600..=10_500).contains(&dots), "{dots} dots");
    }

    #[test]
    fn numbers_on_an_axis_are_round_and_include_both_ends() {
        struct Hint;
        impl KeyPointHint for Hint {
            fn max_num_points(&self) -> usize {
                11
            }
            fn weight(&self) -> plotters::coord::ranged1d::KeyPointWeight {
                unreachable!("the axis has one kind of key points")
            }
            fn bold_points(&self) -> usize {
                11
            }
        }
        assert_eq!(Ends((0.5, 10.0)).key_points(Hint), [0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0]);
        assert_eq!(Ends((5.0, 60.0)).key_points(Hint).first(), Some(&5.0));
        let text: Vec<String> = Ends((0.2, 0.8)).key_points(Hint).iter().map(Ends::format).collect();
        assert_eq!(text.first().map(String::as_str), Some("0.2"));
        assert!(text.iter().all(|number| number.len() <= 4), "{text:?}");
    }
}
