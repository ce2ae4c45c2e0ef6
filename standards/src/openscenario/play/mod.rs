//! A storyboard at play: the states of its elements and of its entities, as they change from tick to tick.

mod actor;
mod cast;
mod find;
mod goals;
mod measure;
mod motion;
mod stage;
mod start;
mod synchronize;
mod track;
mod watch;

pub(super) use find::Unplayable;
pub(super) use goals::check_goals;
pub(super) use stage::Stage;
