//! Makes an array smaller for as long as there is time.

use super::halves::Halves;
use super::search::{Annealing, Bits, Cells, Table, Tally, Tenure};
use super::symmetric::{Symmetric, symmetric_searches};
use super::task::Task;
use super::{CoveringArray, CoveringRequest, joined};
use crate::seeded::mix;
use paracosm_coverage::Deadline;
use paracosm_space::rules::Rules;
use std::sync::Mutex;
use std::thread;

/// The number of steps between two looks at the clock.
const STEPS_BETWEEN_LOOKS: usize = 64;

/// The number of steps in which a row of a core falls easily.
const EASY_STEPS: usize = 4096;

/// The number of cells of all searches with a table together, four bytes each, unless a single search has more.
const CELLS_AT_ONCE: usize = 12_000_000;

/// The number of cells beyond which there is no search for symmetric arrays.
const CELLS_OF_SYMMETRIC: usize = 1_000_000;

/// The number of looks at the clock after which another kind of symmetry is tried.
const LOOKS_IN_TURN: usize = 256;

/// Reduces the number of tests of a covering array, until the deadline passes or the lower bound is reached.
/// [`covering_array`](super::covering_array) must have constructed the array for the same request. Existing rows stay.
/// `progress` is called with each new size.
///
/// All cores search, each from the best array found so far. The result depends on the available time. It covers as
/// much as the given array and is never larger.
pub fn optimise(
    request: &CoveringRequest,
    array: CoveringArray,
    deadline: Deadline,
    progress: &(dyn Fn(usize) + Sync),
) -> CoveringArray {
    let (tasks, _) = Task::all(request);
    let CoveringArray { rows, kept, invalid, lower_bound } = array;
    let mut all = rows.len();
    let mut parts: Vec<(Vec<Vec<usize>>, usize)> = vec![(Vec::new(), 0); tasks.len()];
    for (index, row) in rows.into_iter().enumerate() {
        let own = Task::of_row(&tasks, &row);
        parts[own].0.push(row);
        parts[own].1 += usize::from(index < kept);
    }
    for (i, (task, (rows, kept))) in tasks.iter().zip(&mut parts).enumerate() {
        let others = all - rows.len();
        let share = deadline.part(1.0 / (tasks.len() - i) as f64);
        *rows = smaller(task, std::mem::take(rows), *kept, share, &|size| progress(others + size));
        all = others + rows.len();
    }
    let (rows, kept) = joined(&tasks, parts);
    CoveringArray { rows, kept, invalid, lower_bound }
}

/// Shrinks the rows of one kind of tests.
fn smaller(
    task: &Task,
    rows: Vec<Vec<usize>>,
    kept: usize,
    deadline: Deadline,
    progress: &(dyn Fn(usize) + Sync),
) -> Vec<Vec<usize>> {
    let goal = (task.lower_bound() as usize).max(kept);
    if rows.len() <= goal {
        return rows;
    }
    let Some(cells) = task.cells().filter(|_| rows.len() < 1 << 16) else { return rows };
    let bits = rows.len() <= Bits::MOST_ROWS;
    let halves = Halves::of(task, rows.len()).filter(|_| kept == 0);
    let best = Best { rows: Mutex::new(rows), goal, deadline, progress };
    let all_cells: usize = cells.iter().map(Cells::len).sum();
    let tables = (CELLS_AT_ONCE / all_cells).max(1);
    // One chain of each tenure at least, if there is memory for two.
    let chains = rayon::current_num_threads().max(2).min(if bits { usize::MAX } else { tables });
    let mut symmetric = if kept == 0 && cells.len() == 1 && all_cells <= CELLS_OF_SYMMETRIC {
        symmetric_searches(task)
    } else {
        Vec::new()
    };
    let tenure = |chain: usize| [Tenure::Growing, Tenure::Short][chain % 2];
    let rows_search = |chain: usize| {
        let seed = mix(task.seed ^ mix(chain as u64));
        if bits {
            best.search_rows::<Bits>(|rows| search(&task.rules, &cells, rows, kept, seed, tenure(chain)));
        } else {
            best.search_rows::<Table>(|rows| search(&task.rules, &cells, rows, kept, seed, tenure(chain)));
        }
    };
    let core_search = |chain: usize, halves: &Halves| {
        let seed = mix(task.seed ^ mix(chain as u64));
        best.search_core(halves, CELLS_AT_ONCE / chains, |cells, rows, turn| {
            Annealing::new(&task.rules, vec![cells], rows, 0, mix(seed ^ turn)).with_tenure(tenure(chain))
        });
    };
    // Uses separate threads, so that the searches share the time on a single core, too.
    thread::scope(|scope| {
        let (rows_search, core_search) = (&rows_search, &core_search);
        for chain in 0..(chains - usize::from(!symmetric.is_empty())).max(chains.min(2)) {
            // If the rest follows from the core, all searches but the first of many are for the core.
            match &halves {
                Some(halves) if chain > 0 || chains <= 2 => scope.spawn(move || {
                    core_search(chain, halves);
                    // The core has become too large, or the search is over.
                    rows_search(chain);
                }),
                _ => scope.spawn(move || rows_search(chain)),
            };
        }
        best.search_symmetric(&mut symmetric);
    });
    best.rows.into_inner().expect("no search panics")
}

/// Begins a search from an array.
fn search<T: Tally>(
    rules: &Rules,
    cells: &[Cells],
    rows: &[Vec<usize>],
    kept: usize,
    seed: u64,
    tenure: Tenure,
) -> Annealing<T> {
    Annealing::new(rules, cells.to_vec(), rows, kept, seed).with_tenure(tenure)
}

/// The smallest array so far, which all searches share.
struct Best<'a> {
    rows: Mutex<Vec<Vec<usize>>>,
    goal: usize,
    deadline: Deadline,
    progress: &'a (dyn Fn(usize) + Sync),
}

impl Best<'_> {
    fn len(&self) -> usize {
        self.rows.lock().expect("no search panics").len()
    }

    /// Returns `true` if a search must go on.
    fn wanted(&self) -> bool {
        !self.deadline.passed() && self.len() > self.goal
    }

    fn offer(&self, found: Vec<Vec<usize>>) {
        let mut rows = self.rows.lock().expect("no search panics");
        if found.len() < rows.len() {
            *rows = found;
            (self.progress)(rows.len());
        }
    }

    /// Searches from the best array, and again whenever another search has found a smaller one.
    fn search_rows<T: Tally>(&self, start: impl Fn(&[Vec<usize>]) -> Annealing<T>) {
        // The others need not wait until the search has begun.
        let best = || self.rows.lock().expect("no search panics").clone();
        let start = || start(&best());
        let mut search = start();
        while self.wanted() {
            search.steps(STEPS_BETWEEN_LOOKS);
            if search.missing() == 0 {
                self.offer(search.rows());
                if !search.drop_row() {
                    return;
                }
            } else if self.len() <= search.len() {
                search = start();
            }
        }
    }

    /// Searches for a core with fewer rows than the best array, and adds the other columns. Where a column cannot be added to a core with one row
    /// less, the search goes on with this column in the core. Returns early if the core then has more than `most` cells. `start` begins the search
    /// of a turn from rows that show which combinations are valid.
    fn search_core(&self, halves: &Halves, most: usize, start: impl Fn(Cells, &[Vec<usize>], u64) -> Annealing) {
        let mut turns = 0..;
        let mut start = |known: usize, rows: &[Vec<usize>]| {
            let cells = halves.cells(known).filter(|cells| cells.len() <= most)?;
            Some(start(cells, rows, turns.next()?))
        };
        while self.wanted() {
            let best = self.rows.lock().expect("no search panics").clone();
            let ended = || !self.wanted() || self.len() < best.len();
            let Some(mut search) = start(0, &best).filter(|search| search.len() > 0) else { return };
            search.drop_row();
            let mut known = 0;
            while !ended() {
                if search.missing() > 0 {
                    search.steps(STEPS_BETWEEN_LOOKS);
                    continue;
                }
                let mut rows = search.rows();
                if known == 0
                    && let Some(mut fewer) = self.fewer_rows(&mut search)
                    && halves.fill(&mut fewer, 0, &ended) == halves.free()
                {
                    self.offer(fewer);
                    break;
                }
                known = halves.fill(&mut rows, known, &ended);
                if known == halves.free() {
                    self.offer(rows);
                    break;
                }
                if ended() {
                    break;
                }
                known += 1;
                let Some(next) = start(known, &[&rows[..], &best].concat()) else { return };
                search = next;
                search.keep_first(rows.len());
            }
        }
    }

    /// Drops the rows of a complete core that fall easily. Returns the rows that are left; `None` if no row falls.
    fn fewer_rows(&self, search: &mut Annealing) -> Option<Vec<Vec<usize>>> {
        let mut fewer = None;
        while search.len() > self.goal && search.drop_row() {
            search.steps(EASY_STEPS);
            if search.missing() > 0 {
                break;
            }
            fewer = Some(search.rows());
        }
        fewer
    }

    /// Searches for symmetric arrays in turns.
    fn search_symmetric(&self, searches: &mut [Symmetric]) {
        while self.wanted() {
            let mut some = false;
            for search in searches.iter_mut() {
                some |= search.shrink_below(self.len());
                for _ in 0..LOOKS_IN_TURN {
                    if self.deadline.passed() {
                        return;
                    }
                    if let Some(rows) = search.steps(STEPS_BETWEEN_LOOKS) {
                        self.offer(rows);
                        break;
                    }
                }
            }
            if !some {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::covering_array;
    use super::*;
    use paracosm_coverage::kwise::kwise_coverage;
    use paracosm_space::rules::{Clause, Literal};
    use std::time::Duration;

    #[test]
    fn a_search_for_the_core_finds_a_smaller_array_of_all_parameters() {
        let levels: Vec<usize> = [3; 6].into_iter().chain([2; 80]).collect();
        let not = |parameter, level| Literal { parameter, levels: (0..3).filter(|other| *other != level).collect() };
        let constraint = vec![Clause { literals: vec![not(0, 1), not(1, 0)] }];
        let rules = Rules::new(&levels, &[constraint]).unwrap();
        let request = CoveringRequest::new(&rules, 2);
        let CoveringArray { rows, .. } = covering_array(&request).unwrap();
        let (tasks, _) = Task::all(&request);
        let halves = Halves::of(&tasks[0], rows.len()).unwrap();
        let (goal, deadline) = (rows.len() - 1, Deadline::after(Duration::from_secs(60)));
        let best = Best { rows: Mutex::new(rows), goal, deadline, progress: &|_| () };
        best.search_core(&halves, usize::MAX, |cells, rows, turn| Annealing::new(&rules, vec![cells], rows, 0, turn));
        let rows = best.rows.into_inner().unwrap();
        let coverage = kwise_coverage(&rules, 2, rows.iter().map(Vec::as_slice)).unwrap();
        assert_eq!((rows.len(), coverage.covered, coverage.invalid.len()), (goal, coverage.valid, 0));
    }
}
