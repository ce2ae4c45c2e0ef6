//! What happens in a failure mode, in words.

use super::Touch;
use crate::Trial;
use paracosm_engine::Metric;

/// Speed in m/s below which what the car touched stood.
const STANDING: f64 = 0.1;

/// A sentence about a mode: from what it violates, what was touched, a typical trial, and the ranges of its figures, of
/// which some set it apart.
pub(super) fn of(
    violates: &[String],
    contact: Option<&Touch>,
    typical: &Trial,
    ranges: &[(&str, [f64; 2])],
    apart: &[&str],
) -> String {
    let range = |figure: &str| ranges.iter().find(|(name, _)| *name == figure).map(|(_, range)| *range);
    let time = || range("critical_time").map(|range| format!("{} s after the start", span(range)));
    let place = || range("critical_travelled").map(|range| format!("after {} m", span(range)));
    let speed = || range("critical_speed").map(|range| format!("at {} m/s", span(range)));
    let Some(contact) = contact else {
        let rest: Vec<String> = [time(), place(), speed()].into_iter().flatten().collect();
        return [vec![format!("violates {}", violates.join(" and "))], rest].concat().join(", ");
    };
    let also = [
        time().filter(|_| apart.contains(&"critical_time")),
        place().filter(|_| apart.contains(&"critical_travelled")),
    ];
    let motion = match contact.motion.as_str() {
        "standing" => "stands",
        "braking" => "brakes",
        _ => "goes on",
    };
    let at = speed().filter(|_| motion != "stands").map(|speed| format!(" {speed}")).unwrap_or_default();
    let also: String = also.into_iter().flatten().map(|text| format!(", {text}")).collect();
    format!("the car {motion}{at}{}{also}", meeting(contact, typical))
}

/// How the car and the other meet, after what the car does.
fn meeting(contact: &Touch, typical: &Trial) -> String {
    let Touch { with, class, face, motion } = contact;
    let other = if with.starts_with(class.as_str()) { format!("the {with}") } else { format!("the {class} `{with}`") };
    let goes = match class.as_str() {
        "pedestrian" => "walks",
        "bicycle" => "rides",
        "car" | "truck" => "drives",
        _ => "comes",
    };
    let side = match face.as_str() {
        "left" | "right" => format!("{face} side"),
        face => face.to_owned(),
    };
    let comes = matches!(typical.metric("other_speed"), Some(Metric::Number(speed)) if *speed > STANDING);
    match face.as_str() {
        "front" if motion != "standing" => format!(" and hits {other} with its front"),
        _ if comes => format!("; {other} {goes} into its {side}"),
        _ => format!(" and touches {other} with its {side}"),
    }
}

/// A range with one decimal; a single number where there is no more to it.
fn span([least, most]: [f64; 2]) -> String {
    let short = |number: f64| {
        let text = format!("{number:.1}");
        let text = text.strip_suffix(".0").unwrap_or(&text);
        if text == "-0" { "0".to_owned() } else { text.to_owned() }
    };
    let [from, to] = [short(least), short(most)];
    if from == to { from } else { format!("{from} to {to}") }
}
