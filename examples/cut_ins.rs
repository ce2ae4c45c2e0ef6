//! Counts the cut-ins of UN R157 in which each reference driver avoids a collision: `cargo run --release --example
//! cut_ins`.
//!
//! 30,000 cut-ins are drawn at random from the regulation's ranges, without those in which the other car would have to
//! drive backwards. Every reference driver, and a driver that never brakes, drives each cut-in in the plain kinematic
//! world. A collision that a driver does not avoid although `ideal` does is the driver's own fault.

use paracosm::engine::driver::reference::{self, Drive, Ideal};
use paracosm::engine::kinematic::{CutIn, Encounter, Ended, Impact, Unbraked};
use paracosm::generators::{Request, Strategy};
use paracosm::space::Space;
use std::error::Error;
use std::fmt::Write;

const CUT_INS: usize = 30_000;
/// The number of points. In 28 of 100 points the other car would drive backwards.
const POINTS: usize = 2 * CUT_INS;

fn cut_ins() -> Result<Vec<Encounter>, Box<dyn Error>> {
    let space = Space::unit_cube(4);
    let mut generator = Strategy::RANDOM.build(&Request { seed: Some(1), ..Request::new(&space, POINTS) })?;
    let points = generator.ask(POINTS).into_iter();
    let cut_ins = points.filter_map(|point| {
        let unit = <[f64; 4]>::try_from(point.continuous).expect("the cube has four dimensions");
        CutIn::from_unit(unit).map(|cut_in| cut_in.encounter())
    });
    Ok(cut_ins.take(CUT_INS).collect())
}

/// Returns the results of the whole example as text.
pub fn report() -> Result<String, Box<dyn Error>> {
    let encounters = cut_ins()?;
    let percent = |count: usize| 100.0 * count as f64 / encounters.len() as f64;
    let mut text = format!("{} cut-ins, in percent\n", encounters.len());
    writeln!(text, "driver  collisions   front    side  own fault  mean impact")?;
    let ideal: Vec<Ended> = encounters.iter().map(|encounter| Ideal::default().best(encounter).1).collect();
    let none: (&str, Drive) = ("none", |encounter| encounter.run(&Unbraked));
    for (name, drive) in std::iter::once(none).chain(reference::ALL) {
        let ended: Vec<Ended> = encounters.iter().map(drive).collect();
        let collisions: Vec<_> = ended.iter().filter_map(|ended| ended.collision).collect();
        let with = |face: Impact| percent(collisions.iter().filter(|collision| collision.face == face).count());
        let own = ended.iter().zip(&ideal).filter(|(own, ideal)| own.collision.is_some() && ideal.collision.is_none());
        let mean = collisions.iter().map(|collision| collision.speed).sum::<f64>() / collisions.len() as f64;
        writeln!(
            text,
            "{name:<8}{:>10.2}{:>8.2}{:>8.2}{:>11.2}{mean:>9.2} m/s",
            percent(collisions.len()),
            with(Impact::Front),
            with(Impact::Side),
            percent(own.count()),
        )?;
    }
    Ok(text)
}

fn main() -> Result<(), Box<dyn Error>> {
    print!("{}", report()?);
    Ok(())
}
