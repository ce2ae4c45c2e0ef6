//! The state machine of a storyboard: which elements start, run and end at a tick (OpenSCENARIO XML 1.3, section 6.6).

use super::actor::Actor;
use super::cast::Cast;
use super::find::Lost;
use super::motion::Motion;
use super::watch::Watch;
use crate::opendrive::Map;
use crate::openscenario::action::Action;
use crate::openscenario::condition::{Condition, Measure, Trigger};
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
    /// The first action that could not begin, by its name, and the reason.
    lost: Option<(String, Lost)>,
}

/// An element of the storyboard at play.
struct Playing {
    item: Item,
    state: State,
    /// The transition of this tick.
    transition: Option<State>,
    runs: u32,
    start: Option<Watch>,
    stop: Option<Watch>,
    /// The motions of an action under way, each with its entity.
    motions: Vec<(usize, Motion)>,
}

impl Stage {
    /// Sets the stage: all entities are where the initial actions put them.
    pub fn new(board: Storyboard, map: Arc<Map>, ego: usize, lead: Lead) -> Result<Self, Lost> {
        let Storyboard { entities, variables, init, items, stop } = board;
        let mut inputs = 0..;
        let mut watch = |trigger: &Option<Trigger>| trigger.as_ref().map(|trigger| Watch::new(trigger, &mut inputs));
        let playing = |item: Item| Playing {
            state: State::Standby,
            transition: None,
            runs: 0,
            start: watch(&item.start),
            stop: watch(&item.stop),
            motions: Vec::new(),
            item,
        };
        let items = items.into_iter().map(playing).collect();
        let actors = entities.into_iter().map(Actor::new).collect();
        let mut stage = Self {
            cast: Cast { map, actors, variables, ego, lead, time: 0.0 },
            items,
            stop: None,
            behind: None,
            stopped: false,
            lost: None,
        };
        stage.stop = stop.map(|stop| Watch::new(&stop, &mut inputs));
        // The initial actions are an action of a story that has begun.
        let kind = Kind::Action(Vec::new(), Action::Nothing);
        let item = Item { name: String::new(), kind, parent: None, start: None, stop: None, most_runs: 1 };
        let mut motions = Vec::new();
        for (entity, action) in &init {
            if let Some(motion) = stage.cast.begin(*entity, action)? {
                motions.push((*entity, motion));
            }
        }
        let (state, transition) = (State::Running, None);
        stage.items.push(Playing { item, state, transition, runs: 0, start: None, stop: None, motions });
        let activates = |playing: &Playing| match &playing.item.kind {
            Kind::Action(actors, Action::Activate { .. }) => actors.contains(&ego),
            _ => false,
        };
        // If nothing activates the controller of the ego vehicle, the controller is active from the beginning.
        if !stage.items.iter().any(activates) {
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

    /// Returns `true` if an element with a name and of a kind is in a state, or has just made a transition.
    fn is_in(&self, name: &str, kind: &str, state: State) -> bool {
        let named = self.items.iter().filter(|playing| playing.item.name == name && playing.item.kind.name() == kind);
        named.into_iter().any(|playing| playing.state == state || playing.transition == Some(state))
    }

    /// Returns the value of a measure.
    pub fn measure(&self, measure: &Measure) -> f64 {
        self.cast.measure(measure, |name, kind, state| self.is_in(name, kind, state))
    }

    /// Plays a tick of `dt` seconds. `truths` are the values of all conditions at its beginning.
    ///
    /// # Errors
    /// An action cannot begin: the name of the action, and the reason.
    pub fn play(&mut self, truths: &[bool], dt: f64) -> Result<(), (String, Lost)> {
        let time = self.cast.time;
        self.stopped |= self.stop.as_mut().is_some_and(|stop| stop.check(time, truths));
        self.items.iter_mut().for_each(|playing| playing.transition = None);
        self.cast.actors.iter_mut().for_each(|actor| actor.step.before = actor.speed);
        for index in 0..self.items.len() {
            self.update(index, truths);
        }
        self.carry_out(dt);
        for index in (0..self.items.len()).rev() {
            self.complete(index);
        }
        for index in 0..self.cast.actors.len() {
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
            self.cast.actors[self.cast.ego].follow(motion, dt);
        }
    }

    /// Starts an element, or stops it, if its triggers say so.
    fn update(&mut self, index: usize, truths: &[bool]) {
        let time = self.cast.time;
        let runs = self.items[index].item.parent.is_none_or(|parent| self.items[parent].state == State::Running);
        let playing = &mut self.items[index];
        let state = playing.state;
        let check = |watch: &mut Watch| watch.check(time, truths);
        let fires = match state {
            State::Standby if runs => playing.start.as_mut().is_none_or(check),
            State::Running => playing.stop.as_mut().is_some_and(check),
            _ => false,
        };
        match state {
            State::Standby if fires => self.start(index),
            State::Running if fires => self.halt(index),
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
                    self.items[index].transition = Some(State::SkipTransition);
                    self.count_run(index);
                    return;
                }
                Priority::Override => running.into_iter().for_each(|other| self.halt(other)),
                Priority::Skip | Priority::Parallel => (),
            }
        }
        let playing = &mut self.items[index];
        (playing.state, playing.transition) = (State::Running, Some(State::StartTransition));
        // What lies within starts afresh.
        for inner in index + 1..self.items.len() {
            if self.items[inner].item.parent == Some(index) {
                let inner = &mut self.items[inner];
                (inner.state, inner.runs) = (State::Standby, 0);
                inner.start.iter_mut().chain(&mut inner.stop).for_each(Watch::reset);
            }
        }
        if let Kind::Change(variable, change) = &self.items[index].item.kind {
            change.apply(&mut self.cast.variables[*variable].value);
        }
        if let Kind::Action(actors, action) = self.items[index].item.kind.clone() {
            for entity in actors {
                match self.cast.begin(entity, &action) {
                    Ok(Some(motion)) => self.take_over(index, entity, motion),
                    Ok(None) => (),
                    Err(lost) => {
                        let name = self.items[index].item.name.clone();
                        self.lost.get_or_insert((name, lost));
                    }
                }
            }
        }
    }

    /// Adds a motion to an action. The motion ends the motions of the same entity in the same domains.
    fn take_over(&mut self, index: usize, entity: usize, motion: Motion) {
        let (along, aside) = motion.domains();
        let clashes = |other: &Motion| {
            let (also_along, also_aside) = other.domains();
            along && also_along || aside && also_aside
        };
        for playing in &mut self.items {
            let count = playing.motions.len();
            playing.motions.retain(|(of, other)| *of != entity || !clashes(other));
            if count > 0 && playing.motions.is_empty() && playing.state == State::Running {
                (playing.state, playing.transition) = (State::Complete, Some(State::StopTransition));
            }
        }
        self.items[index].motions.push((entity, motion));
    }

    /// Stops an element and all elements within it.
    fn halt(&mut self, index: usize) {
        let mut stopped = vec![index];
        let mut next = 0;
        while let Some(parent) = stopped.get(next).copied() {
            let playing = &mut self.items[parent];
            if playing.state != State::Complete {
                (playing.state, playing.transition) = (State::Complete, Some(State::StopTransition));
            }
            playing.motions.clear();
            stopped
                .extend((parent + 1..self.items.len()).filter(|inner| self.items[*inner].item.parent == Some(parent)));
            next += 1;
        }
    }

    fn carry_out(&mut self, dt: f64) {
        for index in 0..self.items.len() {
            let mut motions = std::mem::take(&mut self.items[index].motions);
            motions.retain_mut(|(entity, motion)| !motion.carry_out(*entity, &mut self.cast, dt));
            self.items[index].motions = motions;
        }
    }

    /// Ends a running element if everything within it is over.
    fn complete(&mut self, index: usize) {
        if self.items[index].state != State::Running {
            return;
        }
        let over = match self.items[index].item.kind {
            Kind::Action(..) | Kind::Change(..) => self.items[index].motions.is_empty(),
            _ => {
                let mut inner = self.items[index + 1..].iter().filter(|inner| inner.item.parent == Some(index));
                inner.all(|inner| inner.state == State::Complete)
            }
        };
        if over {
            self.items[index].transition = Some(State::EndTransition);
            self.count_run(index);
        }
    }

    /// Counts a run of an element: it waits for its next run, or it is complete.
    fn count_run(&mut self, index: usize) {
        let playing = &mut self.items[index];
        playing.runs += 1;
        let again = playing.runs < playing.item.most_runs;
        playing.state = if again { State::Standby } else { State::Complete };
        if again {
            playing.start.iter_mut().chain(&mut playing.stop).for_each(Watch::reset);
        }
    }
}
