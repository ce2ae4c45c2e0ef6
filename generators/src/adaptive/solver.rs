//! Runs solvers with a loop of their own: each on its own thread, exchanging batches of places for costs over
//! channels.
//!
//! To the solver, the tests are a cost function that is slow. A request for the next batch waits only until the
//! solver has decided, which takes microseconds and needs no result; so proposals depend on the results and never on
//! time. When a `Solver` is dropped, its cost function fails, which ends the solver, and the drop waits for the
//! thread.

use super::are_alike;
use argmin::core::{CostFunction, Error};
use std::borrow::Borrow;
use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{Builder, JoinHandle};

/// A solver that runs in a thread of its own and requests costs in batches.
pub(super) struct Solver {
    batches: Receiver<Vec<Vec<f64>>>,
    /// The sender of costs; `None` only during the drop.
    costs: Option<Sender<Vec<f64>>>,
    thread: Option<JoinHandle<()>>,
}

impl Solver {
    /// Starts a solver in a new thread, which ends when `run` ends or the cost function fails.
    pub(super) fn start(run: impl FnOnce(Cost) + Send + 'static) -> Self {
        let (to_us, batches) = channel();
        let (costs, from_us) = channel();
        let cost = Cost { batches: to_us, costs: from_us, patience: None };
        // Without a thread, the other ends of the channels are gone: the solver then has nothing to propose.
        let thread = Builder::new().name("solver".to_owned()).spawn(move || run(cost)).ok();
        Self { batches, costs: Some(costs), thread }
    }

    /// Returns the batch of places whose costs the solver needs next; `None` when the solver has ended. Every batch
    /// must be answered before the next is requested.
    pub(super) fn batch(&self) -> Option<Vec<Vec<f64>>> {
        self.batches.recv().ok()
    }

    /// Sends the costs of the last batch to the solver.
    pub(super) fn answer(&self, costs: Vec<f64>) {
        // A solver that has ended does not listen.
        let _ = self.costs.as_ref().map(|sender| sender.send(costs));
    }
}

impl Drop for Solver {
    fn drop(&mut self) {
        self.costs = None;
        if let Some(thread) = self.thread.take() {
            // A panic ends the solver like anything else.
            let _ = thread.join();
        }
    }
}

/// The cost function of a solver, which waits for the results of tests.
pub(super) struct Cost {
    batches: Sender<Vec<Vec<f64>>>,
    costs: Receiver<Vec<f64>>,
    patience: Option<Mutex<Patience>>,
}

/// Decides when a solver has had enough time.
struct Patience {
    batches: usize,
    /// The best costs of the last batches.
    recent: VecDeque<f64>,
}

impl Cost {
    /// Makes the cost function fail, which ends the solver, as soon as the best costs of `batches` batches in a row
    /// are alike.
    pub(super) fn with_patience(self, batches: usize) -> Self {
        Self { patience: Some(Mutex::new(Patience { batches, recent: VecDeque::new() })), ..self }
    }

    fn of(&self, batch: Vec<Vec<f64>>) -> Result<Vec<f64>, Error> {
        if self.patience.as_ref().is_some_and(|patience| lock(patience).is_over()) {
            return Err(Error::msg("nothing better is to be expected"));
        }
        self.batches.send(batch)?;
        let costs = self.costs.recv()?;
        if let Some(patience) = &self.patience {
            lock(patience).learn(&costs);
        }
        Ok(costs)
    }
}

impl Patience {
    fn learn(&mut self, costs: &[f64]) {
        self.recent.extend(costs.iter().copied().min_by(f64::total_cmp));
        if self.recent.len() > self.batches {
            self.recent.pop_front();
        }
    }

    fn is_over(&self) -> bool {
        self.recent.len() == self.batches && are_alike(self.recent.iter().copied())
    }
}

/// Locks a mutex, even if a thread panicked while the thread held the mutex.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl CostFunction for Cost {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, at: &Vec<f64>) -> Result<f64, Error> {
        Ok(self.of(vec![at.clone()])?[0])
    }

    fn bulk_cost<P: Borrow<Vec<f64>>>(&self, places: &[P]) -> Result<Vec<f64>, Error> {
        self.of(places.iter().map(|at| at.borrow().clone()).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Counts itself for as long as it lives.
    struct Alive(Arc<AtomicUsize>);

    impl Drop for Alive {
        fn drop(&mut self) {
            self.0.fetch_sub(1, Ordering::SeqCst);
        }
    }

    fn walker(alive: &Arc<AtomicUsize>, steps: usize) -> Solver {
        alive.fetch_add(1, Ordering::SeqCst);
        let alive = Alive(alive.clone());
        Solver::start(move |cost| {
            let _alive = alive;
            let mut at = 0.0;
            for _ in 0..steps {
                let Ok(costs) = cost.bulk_cost(&[vec![at], vec![at + 1.0]]) else { return };
                at += costs[1] - costs[0];
            }
        })
    }

    #[test]
    fn a_solver_gets_its_costs_and_ends() {
        let alive = Arc::new(AtomicUsize::new(0));
        let solver = walker(&alive, 3);
        for at in [0.0, 2.0, 4.0] {
            assert_eq!(solver.batch(), Some(vec![vec![at], vec![at + 1.0]]));
            solver.answer(vec![0.0, 2.0]);
        }
        assert_eq!(solver.batch(), None);
        assert_eq!(solver.batch(), None);
        solver.answer(vec![0.0]);
    }

    #[test]
    fn patience_ends_a_solver_whose_costs_are_alike_but_not_one_that_comes_near_0() {
        let batches = |costs: fn(f64) -> f64| {
            let solver = Solver::start(|cost| {
                let cost = cost.with_patience(4);
                (0..20).try_for_each(|i| cost.cost(&vec![f64::from(i)]).map(|_| ())).ok();
            });
            let mut count = 0;
            while let Some(batch) = solver.batch() {
                count += 1;
                solver.answer(vec![costs(batch[0][0])]);
            }
            count
        };
        assert_eq!(batches(|i| if i < 5.0 { 9.0 - i } else { 1.0 }), 9);
        assert_eq!(batches(|i| libm::exp(-i)), 20);
    }

    #[test]
    fn no_thread_outlives_its_solver_wherever_it_stands() {
        let alive = Arc::new(AtomicUsize::new(0));
        drop(walker(&alive, 9));
        let asked = walker(&alive, 9);
        asked.batch();
        drop(asked);
        let answered = walker(&alive, 9);
        answered.batch();
        answered.answer(vec![0.0, 1.0]);
        drop(answered);
        let over = walker(&alive, 0);
        assert_eq!(over.batch(), None);
        drop(over);
        drop(Solver::start(|_| panic!("a solver that breaks")));
        assert_eq!(alive.load(Ordering::SeqCst), 0);
    }
}
