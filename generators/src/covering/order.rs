//! Orders the rows so that a campaign that is stopped early has covered as much as possible.
//!
//! The next row is always the row that covers most of the rest. The gain of a row never grows, so rows are examined
//! again only while they lead (Minoux, *Accelerated greedy algorithms*, 1978).

use super::task::Task;
use paracosm_coverage::kwise::KwiseCounter;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The limit of the work for each family of a task, in choices of parameters for pairs of rows. If it is too small
/// for combinations of the family's strength, combinations of fewer levels decide the order. With very many rows the
/// order stays as it is.
const MOST_LOOKS: usize = 20_000_000;

/// Counts how much of a task's combinations the rows cover.
struct Counters(Vec<KwiseCounter>);

impl Counters {
    fn new(task: &Task, rows: usize) -> Self {
        let counters = task.families.iter().filter_map(|(members, most)| {
            let heads = |strength: usize| (0..strength - 1).fold(1, |heads, i| heads * (members.len() - i) / (i + 1));
            let affordable = |&strength: &usize| {
                let looks = heads(strength).checked_mul(rows * rows);
                looks.is_some_and(|looks| looks <= MOST_LOOKS)
            };
            let strengths = (1..=*most).rev().filter(affordable);
            strengths.map(|strength| KwiseCounter::among(&task.rules, members, strength)).find_map(Result::ok)
        });
        Self(counters.collect())
    }

    /// The number of combinations that a row would add.
    fn gain(&self, row: &[usize]) -> u64 {
        self.0.iter().map(|counter| counter.gain(row).expect("rows are tests of the space")).sum()
    }

    fn add(&mut self, row: &[usize]) {
        for counter in &mut self.0 {
            counter.add(row).expect("rows are tests of the space");
        }
    }
}

/// Orders the rows from position `kept` on. Each row is judged by the task that it belongs to.
pub(super) fn order(tasks: &[Task], rows: Vec<Vec<usize>>, kept: usize) -> Vec<Vec<usize>> {
    let own: Vec<usize> = rows.iter().map(|row| Task::of_row(tasks, row)).collect();
    let mut sizes = vec![0; tasks.len()];
    own.iter().for_each(|&task| sizes[task] += 1);
    let mut counters: Vec<Counters> = tasks.iter().zip(sizes).map(|(task, rows)| Counters::new(task, rows)).collect();
    if counters.iter().all(|counters| counters.0.is_empty()) {
        return rows;
    }
    for (row, &task) in rows[..kept].iter().zip(&own) {
        counters[task].add(row);
    }
    let mut order: Vec<usize> = (0..kept).collect();
    let mut waiting: BinaryHeap<(u64, Reverse<usize>)> =
        (kept..rows.len()).map(|index| (counters[own[index]].gain(&rows[index]), Reverse(index))).collect();
    while let Some((_, Reverse(index))) = waiting.pop() {
        let now = (counters[own[index]].gain(&rows[index]), Reverse(index));
        if waiting.peek().is_some_and(|next| *next > now) {
            waiting.push(now);
        } else {
            counters[own[index]].add(&rows[index]);
            order.push(index);
        }
    }
    let mut rows: Vec<Option<Vec<usize>>> = rows.into_iter().map(Some).collect();
    order.into_iter().map(|index| rows[index].take().expect("every row comes once")).collect()
}
