//! The order of the rows: a campaign that is stopped early has covered as much as possible.
//!
//! Next comes always the row that covers most of what is left. What a row would cover only falls, so rows are
//! looked at anew only while they lead (Minoux, *Accelerated greedy algorithms*, 1978).

use paracosm_coverage::kwise::KwiseCounter;
use paracosm_coverage::rules::Rules;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// How much may be looked at, in choices of parameters for pairs of rows. Where that does not suffice for
/// combinations of k levels, the order is by combinations of fewer; with very many rows it stays as it is.
const MOST_LOOKS: usize = 20_000_000;

/// Orders the rows from `kept` on.
pub(super) fn order(rules: &Rules, k: usize, rows: Vec<Vec<usize>>, kept: usize) -> Vec<Vec<usize>> {
    let parameters = rules.levels().len();
    let heads = |strength: usize| (0..strength - 1).fold(1, |heads, i| heads * (parameters - i) / (i + 1));
    let affordable = |&strength: &usize| {
        let looks = heads(strength).checked_mul(rows.len() * rows.len());
        looks.is_some_and(|looks| looks <= MOST_LOOKS)
    };
    let counter = (1..=k).rev().find(affordable).map(|strength| KwiseCounter::new(rules, strength));
    let Some(Ok(mut counter)) = counter else { return rows };
    let gain = |counter: &KwiseCounter, row: &[usize]| counter.gain(row).expect("rows are tests of the space");
    for row in &rows[..kept] {
        counter.add(row).expect("rows are tests of the space");
    }
    let mut order: Vec<usize> = (0..kept).collect();
    let mut waiting: BinaryHeap<(u64, Reverse<usize>)> =
        (kept..rows.len()).map(|index| (gain(&counter, &rows[index]), Reverse(index))).collect();
    while let Some((_, Reverse(index))) = waiting.pop() {
        let now = (gain(&counter, &rows[index]), Reverse(index));
        if waiting.peek().is_some_and(|next| *next > now) {
            waiting.push(now);
        } else {
            counter.add(&rows[index]).expect("rows are tests of the space");
            order.push(index);
        }
    }
    let mut rows: Vec<Option<Vec<usize>>> = rows.into_iter().map(Some).collect();
    order.into_iter().map(|index| rows[index].take().expect("every row comes once")).collect()
}
