//! Files of roads: our own small files, and published maps with the results of another program.

mod bounds;
mod cases;
mod judge;
mod lanes;
mod networks;
mod notes;
mod objects;
mod others;
mod round_trip;
mod shapes;
mod traffic;
