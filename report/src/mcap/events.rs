//! The events of a run as log messages: its beginning with the values of the test, the violation of a requirement, the contact, and the verdict.

use super::Recorded;
use super::recorder::Recorder;
use super::scene::stamp;
use super::tape::Tape;
use crate::margin::margins;
use foxglove::messages::{Log, log::Level};
use paracosm_campaign::Error;
use paracosm_oracles::Verdict;
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
    let values = study.space().parameters().iter().zip(trial.test.iter()).map(|(parameter, (name, value))| {
        let unit = parameter.unit.as_deref().map(|unit| format!(" {unit}")).unwrap_or_default();
        format!("{name} {value}{unit}")
    });
    let values = values.collect::<Vec<_>>().join(", ");
    say(0.0, Level::Info, "test", format!("test {} begins: {values}", trial.index));
    for margin in trace.iter().flat_map(|trace| margins(study, trace).into_iter().map(|margin| (trace.dt(), margin))) {
        let (dt, margin) = margin;
        // From here on, nothing that follows can satisfy the requirement.
        if let Some(tick) = margin.bounds.iter().position(|(_, upper)| *upper < 0.0) {
            let message = format!("{} is violated: {}", margin.requirement.id, margin.requirement.text);
            say(tick as f64 * dt, Level::Error, "requirement", message);
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
