//! Scenarios of files, against the trajectories that esmini computed for them.

mod golden;
#[path = "../roads/others.rs"]
mod others;
