//! Scenarios of files: our own small files, and scenarios of others with the trajectories that esmini computed for them.

mod bad;
mod chances;
mod complete;
mod concrete;
mod declarations;
mod drawing;
mod exports;
mod golden;
mod joined;
mod measures;
#[path = "../roads/others.rs"]
mod others;
mod page;
mod parameters;
mod places;
mod runs;
mod semantics;
mod strict;
mod strict_values;
mod suites;
mod things;
mod trajectories;
mod weather;
mod worlds;
