//! The bounds of the robustness of a requirement while a run goes on.

use paracosm_campaign::{StatedRequirement, Study};
use paracosm_oracles::{Monitor, Trace, Truth};

/// The bounds of the robustness of a requirement at each tick of a trace.
pub(crate) struct Margin<'s> {
    pub requirement: &'s StatedRequirement,
    /// The lower and the upper bound at each tick: what follows can only lower the upper bound and raise the lower bound.
    pub bounds: Vec<(f64, f64)>,
    /// The robustness of the whole run; `None` if it is undecided.
    pub end: Option<f64>,
}

/// Returns the bounds for each requirement of a study that has a formula which the trace can be judged by.
pub(crate) fn margins<'s>(study: &'s Study, trace: &Trace) -> Vec<Margin<'s>> {
    study.requirements().iter().filter_map(|requirement| margin(requirement, trace)).collect()
}

fn margin<'s>(requirement: &'s StatedRequirement, trace: &Trace) -> Option<Margin<'s>> {
    let mut monitor = Monitor::new(requirement.formula.as_ref()?, trace.signals(), trace.dt()).ok()?;
    let mut bounds = Vec::with_capacity(trace.len());
    for row in trace.rows() {
        monitor.step(row).ok()?;
        bounds.push(monitor.bounds());
    }
    // At the end, the evaluation is exact, unless the run ended too early for the requirement.
    let end = monitor.finish(trace.is_complete());
    let end = (end.truth != Truth::Undecided).then_some(end.robustness);
    if let Some(robustness) = end {
        *bounds.last_mut()? = (robustness, robustness);
    }
    Some(Margin { requirement, bounds, end })
}
