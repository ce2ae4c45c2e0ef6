//! The limit of a measurement: a time, or an amount of work that is the same on every machine.

use paracosm_campaign::Failure;
use paracosm_campaign::executor::alone;
use paracosm_coverage::Deadline;
use std::time::Duration;

/// The limit of a measurement. Measures that do not finish give brackets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// The measurement runs to its end.
    None,
    /// The measurement ends after this time, on all cores. The result depends on the machine.
    Time(Duration),
    /// The measurement runs on one thread, and ends after it has looked at this number of numbers. The result is the same on
    /// every machine.
    Work(u64),
}

impl Limit {
    /// The limit of work of the results that are written beside a campaign. It takes some seconds of one core.
    pub const USUAL: Self = Self::Work(2_000_000_000);

    /// The limit of work of one measure of one set in a comparison of strategies. It takes some 20 s of one core.
    pub const LONG: Self = Self::Work(20_000_000_000);

    /// Does some work until a deadline.
    ///
    /// # Errors
    /// The system cannot start a thread.
    pub(crate) fn within<T: Send>(self, work: impl FnOnce(Deadline) -> T + Send) -> Result<T, Failure> {
        match self {
            Self::None | Self::Time(_) => Ok(work(self.here())),
            Self::Work(_) => alone(|| work(self.here())),
        }
    }

    /// Returns the deadline of work that begins now, and that runs on this thread alone if work is limited.
    pub(crate) fn here(self) -> Deadline {
        match self {
            Self::None => Deadline::never(),
            Self::Time(limit) => Deadline::after(limit),
            Self::Work(limit) => Deadline::after_work(limit),
        }
    }
}

/// A limit of time, or none.
impl From<Option<Duration>> for Limit {
    fn from(limit: Option<Duration>) -> Self {
        limit.map_or(Self::None, Self::Time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Coverage;
    use paracosm_campaign::TestSet;
    use paracosm_coverage::Measure;
    use paracosm_generators::{Request, Strategy};
    use paracosm_space::Space;
    use std::thread;

    #[test]
    fn a_limit_of_work_gives_the_same_brackets_whatever_the_machine_does() {
        let tests = |dims| {
            let space = Space::unit_cube(dims);
            let points = Strategy::HALTON.build(&Request::new(&space, 300)).unwrap().ask(300);
            TestSet::new(space, points)
        };
        for (dims, work) in [(4, 3_000_000), (7, 20_000_000)] {
            let tests = tests(dims);
            let measures: Vec<Measure> = Measure::all().collect();
            let measured = || Coverage::of(&tests, &measures, Some(3), Limit::Work(work)).unwrap();
            let alone = measured();
            // The limit ends most searches, so the brackets depend on where it does.
            let continuous = alone.continuous.as_ref().unwrap();
            let open = continuous.measured.iter().filter(|(_, found)| found.bracket().is_none_or(|b| !b.is_exact()));
            assert!(open.count() >= 2, "{dims}: {alone:?}");
            let together = thread::scope(|scope| {
                let others: Vec<_> = (0..4).map(|_| scope.spawn(measured)).collect();
                others.into_iter().map(|other| other.join().unwrap()).collect::<Vec<Coverage>>()
            });
            assert!(together.iter().all(|other| *other == alone), "{dims}");
        }
    }
}
