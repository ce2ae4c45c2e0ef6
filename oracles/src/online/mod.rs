//! Evaluates formulas tick by tick, while the trace is being recorded.
//!
//! Two parts work side by side. The [`decider`] uses truths only, and reports the truth of the formula at the first
//! tick at which it is certain. The [`stream`] computes the robustness. It is late by the time that the formula looks
//! ahead, and computes the rest at the end. Both take constant time per tick on average, for any time bounds.

mod decider;
mod runs;
mod scan;
mod stream;

use crate::core::{Beyond, Core, CoreKind};
use crate::worth::Worth;
use crate::{Evaluation, EvaluationError, Formula, Truth};
use decider::Decider;
use stream::Stream;

/// A monitor that evaluates a formula tick by tick, while a run records its samples.
///
/// ```
/// use paracosm_oracles::{Formula, Monitor, Truth};
///
/// let formula: Formula = "always[0,2] (speed < 120)".parse().unwrap();
/// let mut monitor = Monitor::new(&formula, &["speed".to_owned()], 1.0).unwrap();
/// assert_eq!(monitor.step(&[80.0]), Ok(Truth::Undecided));
/// assert_eq!(monitor.bounds(), (f64::NEG_INFINITY, 40.0));
/// assert_eq!(monitor.step(&[125.0]), Ok(Truth::Violated));
/// assert_eq!(monitor.finish(false).robustness, -5.0);
/// ```
///
/// The time bounds of the formula limit the memory, with two exceptions. An operator of the future without an end,
/// inside another temporal operator, stores all of its samples. Undecided truths are stored as long as they are
/// undecided, by the ticks at which they change.
#[derive(Debug, Clone)]
pub struct Monitor {
    core: Core,
    columns: usize,
    dt: f64,
    needed: Vec<usize>,
    /// The worth of each atom at this tick, by node.
    atoms: Vec<Option<Worth>>,
    ticks: usize,
    truth: Truth,
    decider: Decider,
    stream: Stream,
}

impl Monitor {
    /// Makes a monitor of a formula, for rows of the given signals that are `dt` seconds apart.
    ///
    /// # Errors
    /// The formula names another signal, or has a time bound between two samples.
    ///
    /// # Panics
    /// `dt` is not a positive number.
    pub fn new(formula: &Formula, signals: &[String], dt: f64) -> Result<Self, EvaluationError> {
        assert!(dt > 0.0, "a sample period is a positive number of seconds");
        let (core, _) = Core::new(formula, signals, dt)?;
        let needed = core.needed(usize::MAX);
        Ok(Self {
            columns: signals.len(),
            dt,
            atoms: vec![None; core.nodes.len()],
            ticks: 0,
            truth: Truth::Undecided,
            decider: Decider::new(&core),
            stream: Stream::new(&core, &needed),
            needed,
            core,
        })
    }

    /// Takes the samples of the next tick, in the order of the signals, and returns the truth of the formula so far. A
    /// truth that is decided does not change any more.
    ///
    /// # Errors
    /// A number that the formula depends on is NaN. The tick then does not count.
    ///
    /// # Panics
    /// The number of samples in the row differs from the number of signals.
    pub fn step(&mut self, row: &[f64]) -> Result<Truth, EvaluationError> {
        assert_eq!(row.len(), self.columns, "one sample per signal");
        let now = self.ticks;
        for (id, node) in self.core.nodes.iter().enumerate() {
            if let CoreKind::Atom(atom) = &node.kind {
                let asked = now < self.needed[id];
                self.atoms[id] = if asked { Some(atom.at(row, || now as f64 * self.dt)?) } else { None };
            }
        }
        self.ticks += 1;
        self.stream.step(&self.core, &self.atoms);
        if self.truth == Truth::Undecided {
            let atoms = |id: usize| self.atoms[id].map(Worth::holds);
            if let Some(holds) = self.decider.step(now, atoms) {
                self.truth = Truth::of(holds);
            }
        }
        Ok(self.truth)
    }

    /// Returns the truth of the formula on the trace so far.
    pub fn truth(&self) -> Truth {
        self.truth
    }

    /// Returns a lower and an upper bound of the robustness, which are valid for every continuation of the trace. Once
    /// the truth is decided, both bounds lie on its side of 0.
    ///
    /// They are not always the closest bounds. The time for those is proportional to the time that the formula looks
    /// ahead; call [`finish`](Self::finish) on a clone of the monitor to get them.
    pub fn bounds(&self) -> (f64, f64) {
        let (lower, upper) = self.stream.bounds(&self.core, self.core.nodes.len() - 1);
        let (lower, upper) = match self.truth {
            Truth::Holds => (lower.max(Worth::of(0.0)), upper),
            Truth::Violated => (lower, upper.min(Worth::of(-0.0))),
            Truth::Undecided => (lower, upper),
        };
        (lower.robustness(), upper.robustness())
    }

    /// Ends the trace, and returns the evaluation of the formula on the trace. It is exactly the result of
    /// [`Formula::evaluate`] on this trace, which is either `complete` or cut short.
    pub fn finish(self, complete: bool) -> Evaluation {
        if self.ticks == 0 {
            return Evaluation::UNKNOWN;
        }
        let [recorded, lower, upper] = [Beyond::Nothing, Beyond::Worst, Beyond::Best]
            .map(|beyond| self.stream.clone().finish(&self.core, &self.needed, self.ticks, complete, beyond));
        Evaluation::new(recorded, lower, upper)
    }
}
