//! Describes in words what happens in a failure mode.

use super::{CriticalFigure, Mode, Touch};
use paracosm_campaign::Trial;
use paracosm_engine::object::Class;
use paracosm_engine::{ContactMotion, Face};
use std::collections::BTreeMap;

/// The speed in m/s below which the other object counts as standing.
const STANDING: f64 = 0.1;

/// The facts that the trials of a mode share.
pub(super) struct Story<'a> {
    pub violates: &'a [String],
    /// The parts of the formulas that were violated, with the ids of the requirements.
    pub parts: &'a [(&'a str, &'a str)],
    /// `true` if the parts distinguish the mode from other modes.
    pub is_told_by_part: bool,
    pub ranges: &'a BTreeMap<CriticalFigure, [f64; 2]>,
    /// The figures by which the mode was separated from other modes.
    pub apart: &'a [CriticalFigure],
}

impl Story<'_> {
    /// Returns a sentence about the mode, with the contact and the speed of the other object in a typical trial.
    pub fn words(&self, contact: Option<&Touch>, typical: &Trial) -> String {
        let time = || self.range(CriticalFigure::Time).map(|range| format!("{} s after the start", span(range)));
        let place = || self.range(CriticalFigure::Travelled).map(|range| format!("after {} m", span(range)));
        let speed = || self.range(CriticalFigure::Speed).map(|range| format!("at {} m/s", span(range)));
        let Some(contact) = contact else {
            let rest = [self.part(), time(), place(), speed()].into_iter().flatten();
            let violates = format!("violates {}", self.violates.join(" and "));
            return [violates].into_iter().chain(rest).collect::<Vec<_>>().join(", ");
        };
        let also = [
            self.part().filter(|_| self.is_told_by_part),
            time().filter(|_| self.apart.contains(&CriticalFigure::Time)),
            place().filter(|_| self.apart.contains(&CriticalFigure::Travelled)),
        ];
        let motion = match contact.motion {
            ContactMotion::Standing => "stands",
            ContactMotion::Braking => "brakes",
            ContactMotion::Driving => "goes on",
        };
        let at = speed()
            .filter(|_| contact.motion != ContactMotion::Standing)
            .map(|speed| format!(" {speed}"))
            .unwrap_or_default();
        let also: String = also.into_iter().flatten().map(|text| format!(", {text}")).collect();
        format!("the car {motion}{at}{}{also}", meeting(contact, typical))
    }

    fn range(&self, figure: CriticalFigure) -> Option<[f64; 2]> {
        self.ranges.get(&figure).copied()
    }

    /// Returns the parts of the formulas that are violated, in words.
    fn part(&self) -> Option<String> {
        by_parts(self.parts.iter().map(|(_, part)| *part))
    }
}

/// A function that describes a mode by one property, if the mode has this property.
type Difference<'a> = dyn Fn(&Mode) -> Option<String> + 'a;

/// Makes the words of all modes different. If several modes share their words, it adds the properties in which they
/// differ: the requirements, the parts of the formulas, the time, the place and the speed of the car, and, if none of
/// these differ, the names.
pub(super) fn tell_apart(modes: &mut [Mode]) {
    let figure = |mode: &Mode, figure| mode.figures.get(&figure).map(|at| span(*at));
    let differences: [&Difference; 6] = [
        &|mode| Some(format!("violating {}", mode.violates.join(" and "))),
        &|mode| by_parts(mode.parts.iter().map(|(_, part)| part.as_str())),
        &|mode| figure(mode, CriticalFigure::Time).map(|time| format!("{time} s after the start")),
        &|mode| figure(mode, CriticalFigure::Travelled).map(|place| format!("after {place} m")),
        &|mode| figure(mode, CriticalFigure::Speed).map(|speed| format!("at {speed} m/s")),
        &|mode| Some(mode.name.clone()),
    ];
    for difference in differences {
        let told: Vec<(String, Option<String>)> =
            modes.iter().map(|mode| (mode.words.clone(), difference(mode))).collect();
        for (mode, (words, own)) in modes.iter_mut().zip(&told) {
            let differs = told.iter().any(|(others, theirs)| others == words && theirs != own);
            own.iter().filter(|_| differs).for_each(|own| mode.words.push_str(&format!(", {own}")));
        }
    }
}

/// Returns the violated parts of formulas in words.
fn by_parts<'a>(parts: impl Iterator<Item = &'a str>) -> Option<String> {
    let parts: Vec<String> = parts.map(|part| format!("`{part}`")).collect();
    (!parts.is_empty()).then(|| format!("by {}", parts.join(" and ")))
}

/// Describes how the car and the object meet, as the rest of a sentence about the car.
fn meeting(contact: &Touch, typical: &Trial) -> String {
    let Touch { with, class, face, motion } = contact;
    let other =
        if with.starts_with(&class.to_string()) { format!("the {with}") } else { format!("the {class} `{with}`") };
    let goes = match class {
        Class::Pedestrian => "walks",
        Class::Bicycle | Class::Motorcycle => "rides",
        Class::Car | Class::Van | Class::Truck | Class::Bus => "drives",
        Class::Building | Class::Tree | Class::Sign | Class::Prop => "comes",
    };
    let side = match face {
        Face::Left | Face::Right => format!("{face} side"),
        Face::Front | Face::Rear => face.to_string(),
    };
    let comes = typical.contact().is_some_and(|contact| contact.other_speed > STANDING);
    match face {
        Face::Front if *motion != ContactMotion::Standing => format!(" and hits {other} with its front"),
        _ if comes => format!("; {other} {goes} into its {side}"),
        _ => format!(" and touches {other} with its {side}"),
    }
}

/// Returns a range with one decimal place, or a single number if both ends are written the same.
fn span([least, most]: [f64; 2]) -> String {
    let short = |number: f64| {
        let text = format!("{number:.1}");
        let text = text.strip_suffix(".0").unwrap_or(&text);
        if text == "-0" { "0".to_owned() } else { text.to_owned() }
    };
    let [from, to] = [short(least), short(most)];
    if from == to { from } else { format!("{from} to {to}") }
}
