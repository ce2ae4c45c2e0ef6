//! Checks the pages of the studies: each number on them follows from a file in the repository.
//!
//! A module for each page computes its tables and the numbers of its sentences. If a table is old, its test prints the table, and with
//! UPDATE_GOLDEN=1 writes it into the page.

mod alks;
mod arch;
mod audit;
mod boundary;
mod cloned_driver;
mod conditions;
mod drivers;
mod fig10;
mod fig9;
mod page;
mod paper;
mod rows;
mod saliency;
mod samplers;
mod stopping_driver;
mod strategies;
mod vision;
