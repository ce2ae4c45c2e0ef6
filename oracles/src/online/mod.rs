//! Formulas followed tick by tick, while the trace is being recorded.
//!
//! Two machines run side by side. One ([`decider`]) knows of truths only and says what the formula comes to at the
//! first tick at which that can be known at all. The other ([`stream`]) computes the robustness, late by as much as the
//! formula looks ahead, and settles at the end what is open then. Both take constant time per tick on average, whatever
//! the time bounds.

mod decider;
mod runs;
mod scan;
mod stream;

use crate::core::{Beyond, Core, CoreKind};
use crate::worth::Worth;
use crate::{Evaluation, EvaluationError, Formula, Truth};
use decider::Decider;
use stream::Stream;

/// A formula that is told the samples as they come.
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
/// Its memory is fixed by the time bounds of the formula, with two exceptions. An operator of the future without an
/// end, within another temporal operator, keeps what it is told. And truths that stay undecided are remembered as long
/// as they do, by their changes.
#[derive(Debug, Clone)]
pub struct Monitor {
    core: Core,
    columns: usize,
    dt: f64,
    needed: Vec<usize>,
    /// What the atoms are worth at this tick, by node.
    atoms: Vec<Option<Worth>>,
    ticks: usize,
    truth: Truth,
    decider: Decider,
    stream: Stream,
}

impl Monitor {
    /// A monitor for rows of these signals, `dt` seconds apart.
    ///
    /// # Errors
    /// The formula names another signal, or has a time bound between two samples.
    ///
    /// # Panics
    /// `dt` is no positive number.
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

    /// Learns the samples of the next tick, in the order of the signals; what the formula's truth is by now. Once it
    /// holds or is violated it stays so.
    ///
    /// # Errors
    /// A number that the formula depends on is NaN. The tick then does not count.
    ///
    /// # Panics
    /// The row has another number of samples than there are signals.
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

    /// The truth by now.
    pub fn truth(&self) -> Truth {
        self.truth
    }

    /// Bounds of the robustness that hold whatever follows, on the side of 0 that the truth says once it is decided.
    ///
    /// They are not always the closest: those take time in proportion to what the formula looks ahead, and are what
    /// [`finish`](Self::finish) gives on a clone of the monitor.
    pub fn bounds(&self) -> (f64, f64) {
        let (lower, upper) = self.stream.bounds(&self.core, self.core.nodes.len() - 1);
        let (lower, upper) = match self.truth {
            Truth::Holds => (lower.max(Worth::of(0.0)), upper),
            Truth::Violated => (lower, upper.min(Worth::of(-0.0))),
            Truth::Undecided => (lower, upper),
        };
        (lower.robustness(), upper.robustness())
    }

    /// What the formula is worth on the trace so far: exactly what [`Formula::evaluate`] says of it, `complete` or cut
    /// short.
    pub fn finish(self, complete: bool) -> Evaluation {
        if self.ticks == 0 {
            return Evaluation::UNKNOWN;
        }
        let [recorded, lower, upper] = [Beyond::Nothing, Beyond::Worst, Beyond::Best]
            .map(|beyond| self.stream.clone().finish(&self.core, &self.needed, self.ticks, complete, beyond));
        Evaluation::new(recorded, lower, upper)
    }
}
