//! Making an array smaller for as long as there is time.

use super::order::order;
use super::search::{Cells, Search};
use super::{CoveringArray, CoveringRequest};
use crate::seeded::mix;
use paracosm_coverage::Deadline;
use rayon::prelude::*;
use std::sync::Mutex;

/// How many steps are taken between looks at the clock.
const STEPS_BETWEEN_LOOKS: usize = 64;

/// The work of polishing, in visits of cells: well below 0.1 s.
const POLISH_WORK: usize = 4_000_000;

/// The work of a step beside its visits of cells and its look at the rows.
const STEP_WORK: usize = 300;

/// Shrinks an array that [`covering_array`](super::covering_array) constructed for the same request, until the
/// deadline or the lower bound. Existing rows stay. `progress` is told each new size.
///
/// All cores search, each from the best array found so far. What is found depends on the time there is; what is
/// returned covers as much as the array given, and is never larger.
pub fn optimise(
    request: &CoveringRequest,
    array: CoveringArray,
    deadline: Deadline,
    progress: &(dyn Fn(usize) + Sync),
) -> CoveringArray {
    let Some(cells) = request.cells().filter(|_| array.rows.len() < 1 << 16) else { return array };
    let goal = (array.lower_bound as usize).max(array.kept);
    let CoveringArray { rows, kept, invalid, lower_bound } = array;
    let best = Mutex::new(rows);
    (0..rayon::current_num_threads()).into_par_iter().for_each(|chain| {
        let seed = mix(request.seed ^ mix(chain as u64));
        let start = || Search::new(request.rules, cells.clone(), &best.lock().expect("no search panics"), kept, seed);
        let mut search = start();
        while !deadline.passed() {
            search.steps(STEPS_BETWEEN_LOOKS);
            let mut best = best.lock().expect("no search panics");
            if search.missing() == 0 {
                if search.len() < best.len() {
                    *best = search.rows();
                    progress(best.len());
                }
                drop(best);
                if search.len() <= goal || !search.drop_row() {
                    return;
                }
            } else if best.len() <= search.len() {
                drop(best);
                search = start();
            }
        }
    });
    let rows = order(request.rules, request.k, best.into_inner().expect("no search panics"), kept);
    CoveringArray { rows, kept, invalid, lower_bound }
}

/// Shrinks rows with a short search by the rules of [`optimise`], the same on every machine. The work is bounded;
/// arrays for which it would not suffice stay as they are.
pub(super) fn polish(request: &CoveringRequest, rows: Vec<Vec<usize>>, kept: usize, goal: usize) -> Vec<Vec<usize>> {
    let Some(cells) = request.cells().filter(|_| rows.len() < 1 << 16) else { return rows };
    let start: usize = cells.iter().map(|cells| cells.in_row() * rows.len()).sum();
    let changed: usize = cells.iter().map(|cells| 2 * cells.in_row() * cells.strength() / cells.members()).sum();
    let step = changed + rows.len() / 2 + STEP_WORK;
    let steps = POLISH_WORK.saturating_sub(start) / step;
    if steps == 0 {
        return rows;
    }
    let mut search = Search::new(request.rules, cells, &rows, kept, request.seed);
    let mut best = rows;
    for _ in 0..steps {
        while search.missing() == 0 {
            if search.len() < best.len() {
                best = search.rows();
            }
            if search.len() <= goal || !search.drop_row() {
                return best;
            }
        }
        search.steps(1);
    }
    if search.missing() == 0 && search.len() < best.len() { search.rows() } else { best }
}

impl CoveringRequest<'_> {
    /// What is to be covered, numbered; none where there is too much of it.
    fn cells(&self) -> Option<Vec<Cells>> {
        let levels = self.rules.levels();
        let all: Vec<usize> = (0..levels.len()).collect();
        let groups = self.groups.iter().filter(|(_, strength)| *strength > self.k);
        let families = std::iter::once((&all, self.k)).chain(groups.map(|(members, strength)| (members, *strength)));
        let numbered = families.map(|(members, strength)| {
            let mut members = members.clone();
            members.sort_unstable();
            Cells::new(levels, &members, strength)
        });
        numbered.collect()
    }
}
