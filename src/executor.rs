//! Work on all cores, results in order.
//!
//! Workers take the next index as soon as they are free, so that what is finished is nearly a prefix; results
//! wait for the ones before them and reach the sink in the order of their indices, whatever the number of
//! workers. The first error of the sink stops the work, and so does a worker that gives up: then the sink still sees
//! what was finished before.

use crate::Error;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;

/// The name that worker threads begin with, by which a panic of a test can be told from a panic of the program.
pub(crate) const WORKER: &str = "paracosm-worker";

/// Threads for this many workers.
pub(crate) fn pool(workers: usize) -> Result<ThreadPool, Error> {
    let builder = ThreadPoolBuilder::new().num_threads(workers).thread_name(|i| format!("{WORKER}-{i}"));
    builder.build().map_err(|error| Error::Usage(format!("cannot start {workers} threads: {error}")))
}

/// Does work on the single thread of a pool, whatever threads it would take elsewhere.
pub(crate) fn alone<T: Send>(single: &ThreadPool, work: impl FnOnce() -> T + Send) -> T {
    // A worker that waited for another pool itself would take up the work of its neighbour meanwhile.
    std::thread::scope(|scope| scope.spawn(|| single.install(work)).join()).expect("the work does not panic")
}

/// Calls `work` for every index on the threads of the pool, each with a worker of its own, and `sink` with the
/// results in order, up to the first index at which a worker gave up.
pub(crate) fn in_order<W, T: Send, E>(
    pool: &ThreadPool,
    indices: Range<usize>,
    new_worker: impl Fn() -> W + Sync,
    work: impl Fn(&mut W, usize) -> Option<T> + Sync,
    mut sink: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let next = AtomicUsize::new(indices.start);
    let stop = AtomicBool::new(false);
    let (sender, results) = mpsc::channel();
    pool.in_place_scope(|scope| {
        for _ in 0..pool.current_num_threads() {
            let sender = sender.clone();
            scope.spawn(|_| {
                let sender = sender;
                let mut worker = new_worker();
                while !stop.load(Ordering::Relaxed) {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= indices.end {
                        break;
                    }
                    let result = work(&mut worker, index);
                    if result.is_none() {
                        stop.store(true, Ordering::Relaxed);
                    }
                    if sender.send((index, result)).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let mut waiting = BTreeMap::new();
        let mut due = indices.start;
        for (index, result) in results {
            waiting.insert(index, result);
            while let Some(result) = waiting.remove(&due) {
                let Some(result) = result else { return Ok(()) };
                due += 1;
                if let Err(error) = sink(result) {
                    stop.store(true, Ordering::Relaxed);
                    return Err(error);
                }
            }
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

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
