//! The state machine of a storyboard: which elements start, run and end at a tick (OpenSCENARIO XML 1.3, section 6.6).

use super::actor::{Actor, Step};
use super::cast::Cast;
use super::find::{Lost, Misplaced, Unplayable};
use super::motion::Motion;
use super::watch::{Question, Watch};
use crate::opendrive::Map;
use crate::openscenario::action::Action;
use crate::openscenario::condition::{Condition, Trigger};
use crate::openscenario::measure::Measure;
use crate::openscenario::state::State;
use crate::openscenario::story::{Item, Kind, Priority, Storyboard};
use paracosm_engine::Lead;
use std::sync::Arc;

/// A storyboard at play.
pub(in crate::openscenario) struct Stage {
    pub cast: Cast,
    items: Vec<Playing>,
    stop: Option<Watch>,
    /// The seconds of the last tick, if the driver's motion during the tick is not known yet.
    behind: Option<f64>,
    /// `true` once the stop trigger has come.
    pub stopped: bool,
    /// The number of transitions so far.
    moment: u64,
    /// The numbers of transitions at the beginnings of the last tick and of the tick before it.
    began: [u64; 2],
    /// The first action that could not begin.
    lost: Option<Unplayable>,
}

/// An element of the storyboard at play.
struct Playing {
    item: Item,
    /// The index after the last element within this one: the elements follow in the order of the file.
    last: usize,
    state: State,
    /// The last transition, with the number of transitions up to it.
    transition: Option<(State, u64)>,
    runs: u32,
    start: Option<Watch>,
    stop: Option<Watch>,
    /// The motions of an action under way, each with its entity.
    motions: Vec<(usize, Motion)>,
}

impl Stage {
    /// Sets the stage: all entities are where the initial actions put them.
    pub fn new(board: Storyboard, map: Arc<Map>, ego: usize, lead: Lead) -> Result<Self, Misplaced> {
        let asked =
            Self::conditions(&board).flat_map(|condition| &condition.check.measures).filter_map(Measure::offroad);
        let asked: Vec<usize> = asked.collect();
        let is_activated = board.activates(ego);
        let Storyboard { entities, variables, surroundings, init, items, stop } = board;
        let mut inputs = 0..;
        let mut watch = |trigger: &Option<Trigger>| trigger.as_ref().map(|trigger| Watch::new(trigger, &mut inputs));
        let playing = |item: Item| Playing {
            state: State::Standby,
            transition: None,
            runs: 0,
            start: watch(&item.start),
            stop: watch(&item.stop),
            motions: Vec::new(),
            last: 0,
            item,
        };
        let mut items: Vec<Playing> = items.into_iter().map(playing).collect();
        for index in (0..items.len()).rev() {
            items[index].last = items[index].last.max(index + 1);
            if let Some(parent) = items[index].item.parent {
                items[parent].last = items[parent].last.max(items[index].last);
            }
        }
        let actors = entities.into_iter().map(Actor::new).collect();
        let mut stage = Self {
            cast: Cast { map, actors, variables, ego, lead, controlled: [false; 2], surroundings, time: 0.0 },
            items,
            stop: None,
            behind: None,
            stopped: false,
            moment: 0,
            began: [0; 2],
            lost: None,
        };
        asked.into_iter().for_each(|entity| stage.cast.actors[entity].offroad = Some(0.0));
        stage.stop = stop.map(|stop| Watch::new(&stop, &mut inputs));
        // The initial actions are an action of a story that has begun.
        let kind = Kind::Action(Vec::new(), Action::Nothing);
        let (name, origin) = Default::default();
        let item = Item { name, origin, kind, parent: None, start: None, stop: None, most_runs: 1 };
        let mut motions = Vec::new();
        // An entity that an action adds later is absent until then, unless an initial action gives it a place.
        for playing in &stage.items {
            if let Kind::Action(actors, Action::Add(_)) = &playing.item.kind {
                actors.iter().for_each(|entity| stage.cast.actors[*entity].present = *entity == ego);
            }
        }
        for (entity, action, line) in &init {
            stage.cast.actors[*entity].present |= matches!(action, Action::Teleport(_));
            let begun = stage.cast.begin(*entity, action).map_err(|lost| {
                let entity = stage.cast.actors[*entity].entity.name.clone();
                Misplaced { line: *line, entity, lost }
            })?;
            if let Some(motion) = begun {
                motions.push((*entity, motion));
            }
        }
        for actor in &mut stage.cast.actors {
            actor.step = Step::default();
            actor.velocity = actor.pose.forward() * actor.speed;
        }
        let (state, transition) = (State::Running, None);
        stage.items.push(Playing { item, last: 0, state, transition, runs: 0, start: None, stop: None, motions });
        // If nothing activates the controller of the ego vehicle, the controller is active from the beginning.
        if !is_activated {
            stage.cast.lead.hand_over();
        }
        stage.cast.lead.to(stage.cast.actors[ego].motion());
        Ok(stage)
    }

    /// Returns all conditions, in the order of their inputs.
    pub fn conditions(board: &Storyboard) -> impl Iterator<Item = &Condition> {
        let triggers = board.items.iter().flat_map(|item| [&item.start, &item.stop]).chain([&board.stop]);
        triggers.flatten().flatten().flatten()
    }

    /// Returns `true` if an element is in a state, or has made a transition since a moment.
    fn is_in(&self, index: usize, state: State, since: u64) -> bool {
        let made = |(transition, moment): (State, u64)| transition == state && moment > since;
        self.items[index].state == state || self.items[index].transition.is_some_and(made)
    }

    /// Answers a question for a state. A transition counts once, and within the tick after it at the latest.
    fn answer(&self, question: &Question) -> bool {
        self.is_in(question.element, question.state, question.since.max(self.began[1]))
    }

    /// Moves an element to a state by a transition.
    fn change(&mut self, index: usize, state: State, transition: State) {
        self.moment += 1;
        (self.items[index].state, self.items[index].transition) = (state, Some((transition, self.moment)));
    }

    /// Returns the value of a measure.
    pub fn measure(&self, measure: &Measure) -> f64 {
        self.cast.measure(measure, |element, state| self.is_in(element, state, self.began[0]))
    }

    /// Plays a tick of `dt` seconds. `truths` are the values of all conditions at its beginning.
    ///
    /// # Errors
    /// An action cannot begin.
    pub fn play(&mut self, truths: &[bool], dt: f64) -> Result<(), Unplayable> {
        self.began = [self.moment, self.began[0]];
        let mut stop = self.stop.take();
        self.stopped |= self.check(&mut stop, truths) == Some(true);
        self.stop = stop;
        self.cast.actors.iter_mut().for_each(|actor| actor.step.before = actor.speed);
        let mut index = 0;
        while index < self.items.len() {
            self.update(index, truths);
            // Nothing runs or starts within an element that does not run.
            let playing = &self.items[index];
            index = if playing.state == State::Running { index + 1 } else { playing.last.max(index + 1) };
        }
        self.carry_out(dt);
        for index in (0..self.items.len()).rev() {
            self.complete(index);
        }
        for index in 0..self.cast.actors.len() {
            if !self.cast.actors[index].present {
                continue;
            }
            if index != self.cast.ego || self.cast.lead.driven().is_none() {
                self.cast.actors[index].advance(dt, &self.cast.map);
            }
        }
        self.cast.lead.to(self.cast.actors[self.cast.ego].motion());
        self.cast.time += dt;
        self.behind = Some(dt);
        self.lost.take().map_or(Ok(()), Err)
    }

    /// Takes over the motion of the ego vehicle during the last tick if a driver drives it. The car moves after the storyboard.
    pub fn catch_up(&mut self) {
        if let (Some(dt), Some(motion)) = (self.behind.take(), self.cast.lead.driven()) {
            self.cast.actors[self.cast.ego].follow(motion, dt, &self.cast.map);
        }
    }

    /// Returns `true` if a trigger is true; `None` without a trigger.
    fn check(&self, watch: &mut Option<Watch>, truths: &[bool]) -> Option<bool> {
        let watch = watch.as_mut()?;
        Some(watch.check(self.cast.time, truths, self.moment, &|question| self.answer(question)))
    }

    /// Starts an element, or stops it, if its triggers say so.
    fn update(&mut self, index: usize, truths: &[bool]) {
        let playing = &mut self.items[index];
        match playing.state {
            State::Standby => {
                let parent = playing.item.parent;
                if parent.is_some_and(|parent| self.items[parent].state != State::Running) {
                    return;
                }
                let mut watch = self.items[index].start.take();
                let fires = self.check(&mut watch, truths) != Some(false);
                self.items[index].start = watch;
                if fires {
                    self.start(index);
                }
            }
            State::Running if playing.stop.is_some() => {
                let mut watch = playing.stop.take();
                let fires = self.check(&mut watch, truths) == Some(true);
                self.items[index].stop = watch;
                if fires {
                    self.halt(index);
                }
            }
            _ => (),
        }
    }

    fn start(&mut self, index: usize) {
        if let Kind::Event(priority) = self.items[index].item.kind {
            let parent = self.items[index].item.parent;
            let beside = |other: &usize| {
                let playing = &self.items[*other];
                *other != index && playing.item.parent == parent && playing.state == State::Running
            };
            let running: Vec<usize> = (0..self.items.len()).filter(beside).collect();
            match priority {
                Priority::Skip if !running.is_empty() => {
                    self.count_run(index, State::SkipTransition);
                    return;
                }
                Priority::Override => running.into_iter().for_each(|other| self.halt(other)),
                Priority::Skip | Priority::Parallel => (),
            }
        }
        self.change(index, State::Running, State::StartTransition);
        // What lies within starts afresh.
        for inner in index + 1..self.items[index].last {
            if self.items[inner].item.parent == Some(index) {
                let inner = &mut self.items[inner];
                (inner.state, inner.runs) = (State::Standby, 0);
                inner.start.iter_mut().chain(&mut inner.stop).for_each(Watch::reset);
            }
        }
        if let Kind::Change(variable, change) = &self.items[index].item.kind
            && let Err(misfit) = self.cast.variables[*variable].change(change)
        {
            self.lose(index, Lost::Misfit(Box::new(misfit)));
        }
        if let Kind::Environment(change) = &self.items[index].item.kind {
            self.cast.surroundings.change(change, self.cast.time);
        }
        if let Kind::Action(actors, action) = self.items[index].item.kind.clone() {
            for entity in actors {
                match self.cast.begin(entity, &action) {
                    Ok(Some(motion)) => {
                        self.end_others(entity, motion.domains());
                        self.items[index].motions.push((entity, motion));
                    }
                    // A speed or a distance that is reached at once ends what moved the entity along before.
                    Ok(None) => {
                        let along = matches!(action, Action::Speed { .. } | Action::Gap { .. } | Action::Delete);
                        self.end_others(entity, (along, action == Action::Delete));
                    }
                    Err(lost) => self.lose(index, lost),
                }
            }
        }
    }

    /// Notes that an action cannot begin.
    fn lose(&mut self, index: usize, lost: Lost) {
        let Item { name: action, origin: (file, line), .. } = self.items[index].item.clone();
        self.lost.get_or_insert(Unplayable { file, line, action, lost });
    }

    /// Ends the motions of an entity along, or aside, or both.
    fn end_others(&mut self, entity: usize, (along, aside): (bool, bool)) {
        let clashes = |other: &Motion| {
            let (also_along, also_aside) = other.domains();
            along && also_along || aside && also_aside
        };
        for other in 0..self.items.len() {
            let playing = &mut self.items[other];
            let count = playing.motions.len();
            playing.motions.retain(|(of, other)| *of != entity || !clashes(other));
            if count > 0 && playing.motions.is_empty() && playing.state == State::Running {
                self.change(other, State::Complete, State::StopTransition);
            }
        }
    }

    /// Stops an element and all elements within it.
    fn halt(&mut self, index: usize) {
        let mut stopped = vec![index];
        let mut next = 0;
        while let Some(parent) = stopped.get(next).copied() {
            if self.items[parent].state != State::Complete {
                self.change(parent, State::Complete, State::StopTransition);
            }
            self.items[parent].motions.clear();
            stopped.extend(
                (parent + 1..self.items[parent].last).filter(|inner| self.items[*inner].item.parent == Some(parent)),
            );
            next += 1;
        }
    }

    fn carry_out(&mut self, dt: f64) {
        // A motion that began before the driver got the car is over.
        let driven = self.cast.lead.driven().map(|_| self.cast.ego);
        for playing in &mut self.items {
            playing.motions.retain_mut(|(entity, motion)| {
                Some(*entity) != driven && !motion.carry_out(*entity, &mut self.cast, dt)
            });
        }
    }

    /// Ends a running element if everything within it is over.
    fn complete(&mut self, index: usize) {
        if self.items[index].state != State::Running {
            return;
        }
        let over = match self.items[index].item.kind {
            Kind::Action(..) | Kind::Change(..) | Kind::Environment(_) => self.items[index].motions.is_empty(),
            _ => {
                let within = &self.items[index + 1..self.items[index].last];
                let mut inner = within.iter().filter(|inner| inner.item.parent == Some(index));
                inner.all(|inner| inner.state == State::Complete)
            }
        };
        if over {
            self.count_run(index, State::EndTransition);
        }
    }

    /// Counts a run of an element that ends by a transition: the element waits for its next run, or it is complete.
    fn count_run(&mut self, index: usize, transition: State) {
        let playing = &mut self.items[index];
        playing.runs += 1;
        let again = playing.runs < playing.item.most_runs;
        if again {
            playing.start.iter_mut().chain(&mut playing.stop).for_each(Watch::reset);
        }
        self.change(index, if again { State::Standby } else { State::Complete }, transition);
    }
}
