//! Decides the truth of a formula as early as possible.
//!
//! Each tick of a sub-formula is decided once. Its truth then goes up the graph to the operators that use the
//! sub-formula, as runs of ticks. Every operator keeps only the runs of its operands that may still matter. So the
//! work is proportional to the number of changes of truths, and not to the time that the formula looks ahead.

use super::runs::{Run, Runs};
use crate::core::{Core, CoreKind, Id, Sight};
use crate::ticks::FOREVER;

/// A run of ticks of a node, and its truth at these ticks, which has just been decided.
type Event = (Run, bool);

#[derive(Debug, Clone)]
enum Operator {
    /// A statement about the tick itself. The caller decides its truth.
    Atom(Id),
    /// At least one of the two operands holds.
    Or { operands: [Id; 2], no: [Runs; 2] },
    /// The operand holds at a tick in sight.
    Any { operand: Id, start: usize, sight: Sight, yes: Runs, no: Runs },
    /// `goal` holds at a tick, at any distance, and `hold` holds until then.
    Until { hold: Id, goal: Id, past: bool, holds: Reach, fails: Reach, goal_no: Runs, hold_no: Runs },
}

#[derive(Debug, Clone)]
struct Node {
    operator: Operator,
    /// `true` if the operands and the result are negated.
    dual: bool,
    /// The ticks whose truth is decided.
    done: Runs,
}

/// Follows a formula tick by tick, and decides its truth.
#[derive(Debug, Clone)]
pub(super) struct Decider {
    nodes: Vec<Node>,
    /// The truths decided at this tick, by node.
    events: Vec<Vec<Event>>,
}

impl Decider {
    pub fn new(core: &Core) -> Self {
        let mut decider = Self { nodes: Vec::new(), events: Vec::new() };
        let mut places = Vec::new();
        for (id, node) in core.nodes.iter().enumerate() {
            let dual = node.dual;
            let place = match node.kind {
                CoreKind::Atom(_) => decider.add(Operator::Atom(id), false),
                CoreKind::Or(left, right) => decider.or([places[left], places[right]], dual),
                CoreKind::Any { operand, start, sight } => decider.any(places[operand], start, sight, dual),
                CoreKind::Until { hold, goal, sight } => {
                    let (hold, goal) = (places[hold], places[goal]);
                    let until = decider.add(Operator::until(hold, goal, sight.past), dual);
                    if sight.end >= FOREVER {
                        until
                    } else {
                        // If the goal is in sight, and it is reached anywhere, then it is reached in sight.
                        let seen = decider.any(goal, 0, sight, dual);
                        decider.or([seen, until], !dual)
                    }
                }
            };
            places.push(place);
        }
        decider
    }

    fn add(&mut self, operator: Operator, dual: bool) -> Id {
        self.nodes.push(Node { operator, dual, done: Runs::default() });
        self.events.push(Vec::new());
        self.nodes.len() - 1
    }

    fn or(&mut self, operands: [Id; 2], dual: bool) -> Id {
        self.add(Operator::Or { operands, no: Default::default() }, dual)
    }

    fn any(&mut self, operand: Id, start: usize, sight: Sight, dual: bool) -> Id {
        self.add(Operator::Any { operand, start, sight, yes: Runs::default(), no: Runs::default() }, dual)
    }

    /// Takes the truths of the comparisons and flags at the next tick, `now`, and returns the truth of the formula at
    /// tick 0 if this tick decides the truth.
    pub fn step(&mut self, now: usize, atoms: impl Fn(Id) -> Option<bool>) -> Option<bool> {
        for (id, node) in self.nodes.iter_mut().enumerate() {
            let (operands, own) = self.events.split_at_mut(id);
            let decided = &mut own[0];
            decided.clear();
            node.step(now, &atoms, operands, decided);
        }
        let root = self.events.last().expect("a formula has a node");
        root.iter().find(|((from, _), _)| *from == 0).map(|(_, holds)| *holds)
    }
}

impl Operator {
    fn until(hold: Id, goal: Id, past: bool) -> Self {
        let (holds, fails) = (Reach::new(past), Reach::new(past));
        Operator::Until { hold, goal, past, holds, fails, goal_no: Runs::default(), hold_no: Runs::default() }
    }
}

impl Node {
    fn step(
        &mut self,
        now: usize,
        atoms: &impl Fn(Id) -> Option<bool>,
        operands: &[Vec<Event>],
        decided: &mut Vec<Event>,
    ) {
        let (dual, done) = (self.dual, &mut self.done);
        let events = |operand: Id| operands[operand].iter().map(|(run, holds)| (*run, holds ^ dual));
        let mut decide = |run: Run, yes: bool| done.complete(run, |run| decided.push((run, yes ^ dual)));
        match &mut self.operator {
            Operator::Atom(id) => decided.extend(atoms(*id).map(|holds| ((now, now), holds))),
            Operator::Or { operands, no } => {
                for side in 0..2 {
                    for (run, yes) in events(operands[side]) {
                        if yes {
                            decide(run, true);
                        } else {
                            no[side].insert(run);
                            no[1 - side].within(run).for_each(|both| decide(both, false));
                        }
                    }
                }
                let open = done.first_absent();
                no.iter_mut().for_each(|no| no.forget(open));
            }
            Operator::Any { operand, start, sight: Sight { past: false, end, .. }, no, .. } => {
                for ((from, to), yes) in events(*operand) {
                    if yes {
                        if let Some(last) = to.checked_sub(*start) {
                            decide((from.saturating_sub(*end), last), true);
                        }
                    } else {
                        let (from, to) = no.insert((from, to));
                        let first = from.saturating_sub(*start);
                        if let Some(last) = to.checked_sub(*end).filter(|last| first <= *last) {
                            decide((first, last), false);
                        }
                    }
                }
                no.forget(done.first_absent() + *start);
            }
            Operator::Any { operand, start, sight: Sight { past: true, end, .. }, yes, no } => {
                for ((from, to), holds) in events(*operand) {
                    if holds {
                        yes.insert((from, to));
                        if from + *start <= now {
                            decide((from + *start, now.min(to + *end)), true);
                        }
                    } else {
                        let (from, to) = no.insert((from, to));
                        let first = if from == 0 { 0 } else { from + *end };
                        if first <= now.min(to + *start) {
                            decide((first, now.min(to + *start)), false);
                        }
                    }
                }
                // The tick is new, and the truths that it depends on may have been decided before.
                match now.checked_sub(*start) {
                    None => decide((now, now), false),
                    Some(last) => {
                        let first = now.saturating_sub(*end);
                        if yes.first_within((first, last)).is_some() {
                            decide((now, now), true);
                        } else if no.containing(last).is_some_and(|run| run.0 <= first) {
                            decide((now, now), false);
                        }
                    }
                }
                let seen = done.first_absent().saturating_sub(*end);
                yes.forget(seen);
                no.forget(seen);
            }
            Operator::Until { hold, goal, past, holds, fails, goal_no, hold_no } => {
                for (run, yes) in events(*hold) {
                    if yes {
                        holds.open(run, |run| decide(run, true));
                    } else {
                        hold_no.insert(run);
                        goal_no.within(run).for_each(|run| fails.seed(run, |run| decide(run, false)));
                    }
                }
                for (run, yes) in events(*goal) {
                    if yes {
                        holds.seed(run, |run| decide(run, true));
                    } else {
                        goal_no.insert(run);
                        fails.open(run, |run| decide(run, false));
                        hold_no.within(run).for_each(|run| fails.seed(run, |run| decide(run, false)));
                        if *past && run.0 == 0 {
                            // Before the first tick the goal was never reached.
                            fails.seed((0, 0), |run| decide(run, false));
                        }
                    }
                }
                let open = done.first_absent().saturating_sub(1);
                holds.forget(open);
                fails.forget(open);
                goal_no.forget(open);
                hold_no.forget(open);
            }
        }
    }
}

/// The ticks from which a seed can be reached through a corridor: forwards in time or, for the past, backwards.
#[derive(Debug, Clone)]
struct Reach {
    past: bool,
    corridor: Runs,
    reached: Runs,
}

impl Reach {
    fn new(past: bool) -> Self {
        Self { past, corridor: Runs::default(), reached: Runs::default() }
    }

    /// Adds seeds, and calls `new` with the ticks that become reached.
    fn seed(&mut self, run: Run, mut new: impl FnMut(Run)) {
        self.reached.complete(run, &mut new);
        let next = if self.past { Some(run.1 + 1) } else { run.0.checked_sub(1) };
        if let Some((next, (from, to))) = next.and_then(|next| Some((next, self.corridor.containing(next)?))) {
            let opened = if self.past { (next, to) } else { (from, next) };
            self.reached.complete(opened, &mut new);
        }
    }

    /// Widens the corridor, and calls `new` with the ticks that become reached.
    fn open(&mut self, run: Run, mut new: impl FnMut(Run)) {
        let (from, to) = self.corridor.insert(run);
        if self.past {
            let before = (from.saturating_sub(1), to.saturating_sub(1));
            if let Some((reached, _)) = self.reached.first_within(before).filter(|run| run.0 < to) {
                self.reached.complete((reached + 1, to), &mut new);
            }
        } else if let Some(reached) = self.reached.last_within((from + 1, to + 1)) {
            self.reached.complete((from, reached - 1), &mut new);
        }
    }

    fn forget(&mut self, before: usize) {
        self.corridor.forget(before);
        self.reached.forget(before);
    }
}
