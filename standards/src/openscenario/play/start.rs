//! The beginning of an action: what it reads from the world at that moment.

use super::actor::{Actor, Whereabouts};
use super::cast::Cast;
use super::find::{Lost, check_lane, find, legs, neighbour, through, track};
use super::motion::Motion;
use crate::openscenario::action::{Action, Beside, Gap, Lane, Lateral, Target, Trajectory};
use crate::openscenario::measure::Metric;
use crate::openscenario::place::Place;
use crate::openscenario::transition::{Dynamics, Extent, Shape};

impl Cast {
    /// Begins an action of an entity. Returns the motion that goes on; `None` if the action is over at once.
    pub(super) fn begin(&mut self, entity: usize, action: &Action) -> Result<Option<Motion>, Lost> {
        // The driver of a car moves it alone.
        if entity == self.ego && action.moves() && self.lead.driven().is_some() {
            return Ok(None);
        }
        if let Action::Gap { entity: other, .. } | Action::Beside(Beside { entity: other, .. }) = action
            && *other == entity
        {
            return Err(Lost::Itself { entity: self.actors[entity].entity.name.clone() });
        }
        Ok(match action {
            Action::Nothing => None,
            Action::Control(handover) => {
                if entity == self.ego {
                    let [lateral, longitudinal] = self.controlled;
                    self.controlled =
                        [handover.lateral.unwrap_or(lateral), handover.longitudinal.unwrap_or(longitudinal)];
                    if self.controlled == [true, true] {
                        self.lead.hand_over();
                    }
                }
                None
            }
            Action::Teleport(position) => {
                let place = find(position, &self.actors, &self.map)?;
                self.actors[entity].put(place, &self.map);
                self.actors[entity].step.stays = true;
                None
            }
            Action::Add(position) => {
                let place = find(position, &self.actors, &self.map)?;
                self.actors[entity].put(place, &self.map);
                self.actors[entity].step.stays = true;
                self.actors[entity].present = true;
                None
            }
            Action::Delete if entity == self.ego => {
                return Err(Lost::Own { entity: self.actors[entity].entity.name.clone() });
            }
            Action::Delete => {
                self.actors[entity].present = false;
                None
            }
            Action::Speed { dynamics, target } => self.speed(entity, *dynamics, *target),
            Action::Profile(profile) => {
                let added = profile.relative_to.map_or(0.0, |other| self.actors[other].speed);
                let actor = &self.actors[entity];
                let own = actor.entity.vehicle.map_or([f64::INFINITY; 2], |own| [own.acceleration, own.deceleration]);
                let profile = profile.of_entity(own);
                let profile = profile.ok_or_else(|| Lost::NoLimits { entity: actor.entity.name.clone() })?;
                let course = profile.begin(actor.speed, actor.acceleration, added);
                Some(Motion::Profile { course, time: 0.0 })
            }
            Action::Gap { entity: other, gap, how, continuous, ahead, limits } => {
                let motion = Motion::Gap {
                    other: *other,
                    gap: *gap,
                    how: *how,
                    continuous: *continuous,
                    ahead: *ahead,
                    limits: *limits,
                };
                // Without limits the entity is where it is to be at once.
                if limits.is_none() {
                    self.close_up(entity, *other, *gap, *how, *ahead)?;
                }
                (limits.is_some() || *continuous).then_some(motion)
            }
            Action::Beside(beside) => {
                let (here, there) = (self.on_lane(entity)?, self.on_lane(beside.entity)?);
                let seen = here.seen(&there, &self.map);
                let apart = here.t(&self.map) - seen.t;
                let side = if seen.is_against { -apart } else { apart };
                let left = beside.left.unwrap_or(side >= 0.0);
                let widths = if beside.freespace { self.half_widths(entity, beside.entity) } else { 0.0 };
                let metres = beside.metres.unwrap_or((apart.abs() - widths).max(0.0)) + widths;
                Some(Motion::Beside { beside: *beside, metres: if left { metres } else { -metres }, speed: 0.0 })
            }
            Action::LaneChange { dynamics, lane, offset } => {
                let mut place = self.on_lane(entity)?;
                let lane = match lane {
                    Lane::Absolute(lane) => *lane,
                    Lane::Relative { entity: of, lanes } => {
                        let other = self.on_lane(*of)?;
                        let left = if other.is_against() { -*lanes } else { *lanes };
                        neighbour(other.lane_below(&self.map), left)
                    }
                };
                check_lane(place.road, lane, place.s, &self.map)?;
                place.enter(lane, &self.map);
                self.actors[entity].set_place(Whereabouts::OnLane(place));
                let target = if place.is_against() { -*offset } else { *offset };
                Some(Motion::LaneChange(dynamics.from(place.offset, target)))
            }
            Action::LaneOffset { shape, most_acceleration, target, continuous } => {
                let place = self.on_lane(entity)?;
                let target = match target {
                    Lateral::Absolute(value) => *value,
                    Lateral::Relative { entity: of, value } => {
                        self.actors[*of].on_lane(&self.map).map_or(0.0, |other| other.offset) + value
                    }
                };
                let target = if place.is_against() { -target } else { target };
                let span = most_acceleration.map_or(0.0, |most| shape.time_within(target - place.offset, most));
                let shape = if span > 0.0 { *shape } else { Shape::Step };
                let dynamics = Dynamics { shape, extent: Extent::Time(span) };
                Some(Motion::LaneOffset { transition: dynamics.from(place.offset, target), continuous: *continuous })
            }
            Action::Trajectory(trajectory) => {
                let motion = self.trajectory(entity, trajectory)?;
                if let Some(Motion::Trajectory { track, s, .. }) = &motion {
                    self.actors[entity].put(Whereabouts::Free(track.at(*s)), &self.map);
                }
                motion
            }
            Action::Route(route) => {
                self.actors[entity].route = Some(legs(route, &self.actors, &self.map)?);
                None
            }
            Action::Acquire(position) => {
                let from = self.on_lane(entity)?;
                let Whereabouts::OnLane(to) = find(position, &self.actors, &self.map)? else {
                    return Err(Lost::Beside);
                };
                self.actors[entity].route = Some(through(&[from, to], &self.map)?);
                None
            }
            Action::Synchronize(sync) => {
                for target in [&sync.master_target, &sync.target] {
                    find(target, &self.actors, &self.map)?;
                }
                Some(Motion::Synchronize(sync.clone()))
            }
        })
    }

    fn speed(&mut self, entity: usize, dynamics: Dynamics, target: Target) -> Option<Motion> {
        let goal = self.target(target);
        let actor = &self.actors[entity];
        let transition = dynamics.of_speed(actor.speed, goal);
        // The performance of a vehicle limits its changes of speed.
        let limit = actor.entity.vehicle.map_or(f64::INFINITY, |vehicle| {
            if goal > actor.speed { vehicle.acceleration } else { vehicle.deceleration }
        });
        let transition = transition.within(limit);
        let continuous = matches!(target, Target::Relative { continuous: true, .. });
        if transition.is_over() {
            self.actors[entity].speed = goal;
        }
        (continuous || !transition.is_over())
            .then_some(Motion::Speed { transition, follows: continuous.then_some(target) })
    }

    /// Returns the present value of the target of a change of speed, in m/s.
    pub(super) fn target(&self, target: Target) -> f64 {
        match target {
            Target::Absolute(speed) => speed,
            Target::Relative { entity, value, is_factor: true, .. } => self.actors[entity].speed * value,
            Target::Relative { entity, value, is_factor: false, .. } => self.actors[entity].speed + value,
        }
    }

    /// Puts an entity at its distance from another entity, at once.
    fn close_up(
        &mut self,
        entity: usize,
        other: usize,
        gap: Gap,
        how: Metric,
        ahead: Option<bool>,
    ) -> Result<(), Lost> {
        let mut place = self.on_lane(entity)?;
        let missing = self.missing(&self.actors[entity], other, gap, how, ahead);
        if !missing.is_finite() {
            let [from, to] = [entity, other].map(|index| self.actors[index].entity.name.clone());
            return Err(Lost::NoWay { from, to });
        }
        place.advance(missing, &self.map);
        self.actors[entity].put(Whereabouts::OnLane(place), &self.map);
        Ok(())
    }

    /// Returns half of the sum of the widths of two entities in metres.
    fn half_widths(&self, entity: usize, other: usize) -> f64 {
        self.actors[entity].entity.half.y + self.actors[other].entity.half.y
    }

    /// Returns the place of an entity on its lane.
    fn on_lane(&self, entity: usize) -> Result<Place, Lost> {
        let actor = &self.actors[entity];
        actor.on_lane(&self.map).ok_or_else(|| Lost::OffRoad { entity: actor.entity.name.clone() })
    }

    /// Returns the metres that an entity has to move forward to have its distance from another entity. `ahead` is `true` if the
    /// entity is to lead the other entity.
    pub(super) fn missing(&self, actor: &Actor, other: usize, gap: Gap, how: Metric, ahead: Option<bool>) -> f64 {
        let to_other = self.distance_to(actor, other, how);
        let wanted = match gap {
            Gap::Metres(metres) => metres,
            Gap::Seconds(seconds) => seconds * self.actors[other].speed.abs(),
        };
        let leads = ahead.unwrap_or(to_other < 0.0);
        if leads { to_other + wanted } else { to_other - wanted }
    }

    fn trajectory(&mut self, entity: usize, trajectory: &Trajectory) -> Result<Option<Motion>, Lost> {
        let from = self.actors[entity].pose;
        let Some(track) = track(&trajectory.way, Some(from), &self.actors, &self.map)? else { return Ok(None) };
        let (metres, length) = (trajectory.from, track.length());
        if metres > length {
            return Err(Lost::Beyond { metres, length });
        }
        let timing = trajectory.timing.map(|timing| {
            let begin = if timing.is_relative { self.time } else { 0.0 };
            // The time up to the place at which the entity begins does not count.
            (timing.scale, timing.offset + begin - timing.scale * track.time_to(metres))
        });
        Ok(Some(Motion::Trajectory { track, s: metres, timing }))
    }
}
