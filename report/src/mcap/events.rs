//! The events of a run as log messages: its beginning with the values of the test, the violation of a requirement, the contact, and the verdict.

use super::Recorded;
use super::recorder::Recorder;
use super::scene::stamp;
use super::tape::Tape;
use crate::with_units::with_units;
use foxglove::messages::{Log, log::Level};
use paracosm_campaign::{Error, StatedRequirement};
use paracosm_oracles::{Monitor, Trace, Truth, Verdict};
use std::io::{Seek, Write};

/// The topic of the events.
const EVENTS: &str = "/events";

/// Adds the messages of all events.
pub(super) fn tell<W: Write + Seek>(
    recorded: &Recorded<'_>,
    recorder: &Recorder,
    tape: &mut Tape<W>,
) -> Result<(), Error> {
    let events = tape.topic::<Log>(EVENTS, &[])?;
    let mut say = |time: f64, level: Level, name: &str, message: String| {
        let (timestamp, level) = (stamp(time), level.into());
        let log = Log { timestamp, level, message, name: name.to_owned(), file: String::new(), line: 0 };
        tape.say(events, time, &log);
    };
    let Recorded { study, trial, trace, .. } = recorded;
    let values = with_units(study, &trial.test);
    say(0.0, Level::Info, "test", format!("test {} begins: {values}", trial.index));
    for requirement in study.requirements() {
        if let Some(time) = trace.and_then(|trace| violated_at(requirement, trace)) {
            say(time, Level::Error, "requirement", format!("{} is violated: {}", requirement.id, requirement.text));
        }
    }
    let moments = recorder.moments.last().map(|last| last.time);
    let end = moments.or_else(|| trace.map(|trace| trace.len().saturating_sub(1) as f64 * trace.dt()));
    let end = end.unwrap_or_default();
    if let (Some(touched), Some(scene)) = (recorder.touched, &recorder.scene) {
        say(end, Level::Error, "contact", format!("{} touches {}", recorder.ego(), scene.bodies[touched].0));
    }
    let level = match trial.verdict {
        Verdict::Pass => Level::Info,
        Verdict::Fail | Verdict::Unpreventable | Verdict::Error => Level::Error,
        Verdict::Inconclusive | Verdict::Invalid => Level::Warning,
    };
    let why = trial.error().map(|error| format!(": {error}")).unwrap_or_default();
    say(end, level, "verdict", format!("{}{why}", trial.verdict));
    Ok(())
}

/// Returns the time in seconds from which a requirement is violated, whatever follows; `None` if it is not violated. The bounds of the
/// robustness do not tell, because the robustness of a violation may be 0.
fn violated_at(requirement: &StatedRequirement, trace: &Trace) -> Option<f64> {
    let mut monitor = Monitor::new(requirement.formula.as_ref()?, trace.signals(), trace.dt()).ok()?;
    for (tick, row) in trace.rows().enumerate() {
        if monitor.step(row).ok()? == Truth::Violated {
            return Some(tick as f64 * trace.dt());
        }
    }
    let is_violated = monitor.finish(trace.is_complete()).truth == Truth::Violated;
    is_violated.then(|| trace.len().saturating_sub(1) as f64 * trace.dt())
}
