//! Runs work on all cores and delivers the results in order.
//!
//! Workers take the next index as soon as they are free, so that finished work is nearly a prefix of all work. Results
//! wait for the results before them, and reach the sink in the order of their indices, whatever the number of workers.
//! The first error of the sink stops the work. A worker that gives up stops it as well, but then the sink still gets
//! the results before that index.

use crate::Failure;
use crate::threads::Threads;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::time::{Duration, Instant};

/// The prefix of the names of worker threads. The prefix distinguishes a panic of a test from a panic of the program.
pub const WORKER: &str = "paracosm-worker";

/// The longest pause in which finished results may wait for the sink.
const MOST_PAUSE: Duration = Duration::from_millis(5);

/// Makes a thread pool with the given number of threads.
///
/// # Errors
/// The system cannot start the threads.
pub fn pool(workers: usize) -> Result<ThreadPool, Failure> {
    pool_of(workers, &Threads::default())
}

/// Makes a thread pool like [`pool`], of threads that work as the program wants.
///
/// # Errors
/// The system cannot start the threads.
pub fn pool_of(workers: usize, threads: &Threads) -> Result<ThreadPool, Failure> {
    let builder = ThreadPoolBuilder::new().num_threads(workers).thread_name(|i| format!("{WORKER}-{i}"));
    let builder = builder.spawn_handler(|thread| {
        let (threads, name) = (threads.clone(), thread.name().unwrap_or(WORKER).to_owned());
        std::thread::Builder::new().name(name).spawn(move || threads.work(|| thread.run())).map(drop)
    });
    builder.build().map_err(|source| Failure::Threads { threads: workers, source })
}

/// A queue that gives the indices of the remaining work to a worker and takes the worker's results.
pub struct Desk<'a, T> {
    next: &'a AtomicUsize,
    end: usize,
    closed: &'a AtomicBool,
    results: Sender<(usize, Option<T>)>,
}

impl<T> Desk<'_, T> {
    /// Returns the next index to work on; `None` if no index is left or the work was stopped.
    pub fn next(&self) -> Option<usize> {
        let index = || self.next.fetch_add(1, Ordering::Relaxed);
        (!self.is_closed()).then(index).filter(|index| *index < self.end)
    }

    /// Returns `true` if the work was stopped, so that further results are not used.
    pub fn is_closed(&self) -> bool {
        self.closed.load(Ordering::Relaxed)
    }

    /// Takes the result of the work on an index. `None` means that the worker gave up, and closes the desk.
    pub fn hand_in(&self, index: usize, result: Option<T>) {
        let gives_up = result.is_none();
        if self.results.send((index, result)).is_err() || gives_up {
            self.closed.store(true, Ordering::Relaxed);
        }
    }
}

/// Runs a function on a single thread, even if the function would use more threads.
///
/// # Errors
/// The system cannot start the thread.
pub fn alone<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    let single = pool(1)?;
    // A worker thread that waited for another pool would itself begin other work in the meantime.
    Ok(std::thread::scope(|scope| scope.spawn(|| single.install(work)).join()).expect("the work does not panic"))
}

/// Calls `work` for every index on the threads of a pool, with a separate worker for each thread. Calls `sink` with the
/// results in order, up to the first index at which a worker gave up.
pub fn in_order<W, T: Send, E>(
    pool: &ThreadPool,
    indices: Range<usize>,
    new_worker: impl Fn() -> W + Sync,
    work: impl Fn(&mut W, usize) -> Option<T> + Sync,
    sink: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let one_by_one = |desk: &Desk<T>| {
        let mut worker = new_worker();
        while let Some(index) = desk.next() {
            desk.hand_in(index, work(&mut worker, index));
        }
    };
    from_desk(pool, indices, one_by_one, sink)
}

/// Calls `work` once on every thread of a pool, and passes the results to `sink` in the order of the indices. `work`
/// takes indices from the desk and hands in their results, so that a worker can work on several indices at a time.
/// Otherwise it works like [`in_order`].
pub fn from_desk<T: Send, E>(
    pool: &ThreadPool,
    indices: Range<usize>,
    work: impl Fn(&Desk<T>) + Sync,
    mut sink: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let next = AtomicUsize::new(indices.start);
    let closed = AtomicBool::new(false);
    let (sender, results) = mpsc::channel();
    pool.in_place_scope(|scope| {
        for _ in 0..pool.current_num_threads() {
            let desk = Desk { next: &next, end: indices.end, closed: &closed, results: sender.clone() };
            scope.spawn(|_| {
                let desk = desk;
                work(&desk);
            });
        }
        drop(sender);
        let mut waiting = BTreeMap::new();
        let mut due = indices.start;
        let begun = Instant::now();
        let pause = |done: usize, left: usize| {
            let rest = begun.elapsed().mul_f64(left as f64 / done.max(1) as f64);
            if done == 0 { Duration::ZERO } else { (rest / 4).min(MOST_PAUSE) }
        };
        while let Some((index, result)) = receive(&results, || pause(due - indices.start, indices.end - due)) {
            waiting.insert(index, result);
            while let Some(result) = waiting.remove(&due) {
                let Some(result) = result else { return Ok(()) };
                due += 1;
                if let Err(error) = sink(result) {
                    closed.store(true, Ordering::Relaxed);
                    return Err(error);
                }
            }
        }
        Ok(())
    })
}

/// Waits for the next result; `None` if there are no more results. If no result is there, it sleeps for a pause before
/// it waits. A thread that waits has to be woken for each result, which takes some hundredths of a short test; results
/// that come during a sleep are received together.
fn receive<T>(results: &Receiver<T>, pause: impl FnOnce() -> Duration) -> Option<T> {
    results.try_recv().ok().or_else(|| {
        std::thread::sleep(pause());
        results.recv().ok()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order_whatever_the_number_of_workers() {
        for jobs in [1, 2, 8] {
            let mut seen = Vec::new();
            let work = |_: &mut (), i: usize| {
                std::thread::sleep(Duration::from_micros((i * 7919 % 50) as u64));
                Some(i)
            };
            let result: Result<(), ()> = in_order(
                &pool(jobs).unwrap(),
                5..200,
                || (),
                work,
                |i| {
                    seen.push(i);
                    Ok(())
                },
            );
            assert_eq!(result, Ok(()));
            assert!(seen.iter().copied().eq(5..200), "{jobs} jobs: {seen:?}");
        }
    }

    #[test]
    fn an_error_of_the_sink_stops_the_work() {
        let mut seen = 0;
        let result = in_order(
            &pool(2).unwrap(),
            0..1_000_000,
            || (),
            |(), i| Some(i),
            |i| {
                seen += 1;
                if i == 10 { Err("full") } else { Ok(()) }
            },
        );
        assert_eq!((result, seen), (Err("full"), 11));
    }

    #[test]
    fn what_was_finished_before_a_worker_gave_up_is_seen() {
        for jobs in [1, 2, 8] {
            let mut seen = Vec::new();
            let work = |(): &mut (), i| (!(20..=22).contains(&i)).then_some(i);
            let slow = |i| {
                std::thread::sleep(Duration::from_millis(1));
                seen.push(i);
                Ok::<(), ()>(())
            };
            assert_eq!(in_order(&pool(jobs).unwrap(), 0..1000, || (), work, slow), Ok(()));
            assert!(seen.iter().copied().eq(0..20), "{jobs} jobs: {seen:?}");
        }
    }

    #[test]
    fn nothing_to_do_is_done_at_once() {
        let result: Result<(), ()> = in_order(&pool(2).unwrap(), 7..7, || (), |(), _| Some(()), |()| Err(()));
        assert_eq!(result, Ok(()));
    }
}
