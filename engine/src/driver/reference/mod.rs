//! Reference drivers, which know the ground truth. These models show whether a careful driver, or any driver, could
//! have avoided a failure.
//!
//! | driver | brakes | source |
//! | --- | --- | --- |
//! | [`cc`](Cc) | like a competent and careful human | UN Regulation No. 157, Annex 4, Appendix 3 |
//! | [`rss`](Rss) | if the distance is not safe in the worst case | Shalev-Shwartz, Shammah, Shashua, "On a Formal Model of Safe and Scalable Self-driving Cars", 2017 |
//! | [`fsm`](Fsm) | the harder, the less safe two fuzzy measures say it is | Mattas et al., "Fuzzy Surrogate Safety Metrics for real-time assessment of rear-end collision risk", Accident Analysis and Prevention 148, 2020; UN R157 as amended |
//! | [`reg157`](Reg157) | as late and as little as UN R157 lets an automated lane keeping system | UN R157, 5.2.5.2 |
//! | [`ideal`](Ideal) | at once, and as hard as is needed | ours |
//!
//! One paper compares models of this kind in one world: Mattas et al., "Driver models for the definition of safety
//! requirements of automated vehicles in international regulations. Application to motorway driving conditions",
//! Accident Analysis and Prevention 174, 2022. The Joint Research Centre published its models as `JRC-FSM`; the page
//! `docs/reference-drivers.md` compares our counts of collisions with theirs. If a source leaves something open, the model's page gives our reading.
//!
//! Each model is a [`BrakingModel`](crate::kinematic::BrakingModel) of one other road user. The kinematic world runs it
//! as it is. An adapter lets it drive a whole simulated car, which has to go on again when the way is free. Both ask it
//! ten times a second. A time that is no multiple of that step is rounded up: no driver reacts faster than its reaction
//! time.

mod adapter;
mod cc;
mod fsm;
mod held;
mod ideal;
mod reg157;
mod rss;

pub use cc::Cc;
pub use fsm::Fsm;
pub use ideal::{Ideal, Profile};
pub use reg157::Reg157;
pub use rss::Rss;

pub(super) use cc::DESCRIPTOR as CC;
pub(super) use fsm::DESCRIPTOR as FSM;
pub(super) use ideal::DESCRIPTOR as IDEAL;
pub(super) use reg157::DESCRIPTOR as REG157;
pub(super) use rss::DESCRIPTOR as RSS;

use crate::kinematic::{Encounter, Ended};

/// A function that drives an encounter with a reference driver and returns the result.
pub type Drive = fn(&Encounter) -> Ended;

/// The reference drivers by name, each with its standard settings.
pub const ALL: [(&str, Drive); 5] = [
    ("cc", |encounter| encounter.run(&Cc::default())),
    ("rss", |encounter| encounter.run(&Rss::default())),
    ("fsm", |encounter| encounter.run(&Fsm::default())),
    ("reg157", |encounter| encounter.run(&Reg157::default())),
    ("ideal", |encounter| Ideal::default().best(encounter).1),
];

#[cfg(test)]
mod tests;
