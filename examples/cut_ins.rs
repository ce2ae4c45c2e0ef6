//! How many cut-ins of UN R157 each reference driver gets out of: `cargo run --release --example cut_ins`.
//!
//! 30,000 cut-ins from the regulation's ranges, drawn at random (those are left out in which the other car would have
//! to drive backwards), each driven by every reference driver in the plain kinematic world. What a driver does not avoid
//! although `ideal` does is its own fault.

use paracosm::coverage::Space;
use paracosm::engine::driver::reference;
use paracosm::engine::kinematic::{CutIn, Encounter, Ended, Face, Unbraked};
use paracosm::generators::{GeneratorError, Request, Strategy};
use std::time::Instant;

const CUT_INS: usize = 30_000;

fn cut_ins() -> Result<Vec<Encounter>, GeneratorError> {
    // Half of the points of the cube are left out.
    let space = Space::unit_cube(4);
    let mut generator = Strategy::Random.build(&Request { seed: Some(1), ..Request::new(&space, 3 * CUT_INS) })?;
    let points = generator.ask(3 * CUT_INS).into_iter();
    let cut_ins = points.filter_map(|point| {
        let unit = <[f64; 4]>::try_from(point.continuous).expect("the cube has four dimensions");
        CutIn::from_unit(unit).map(|cut_in| cut_in.encounter())
    });
    Ok(cut_ins.take(CUT_INS).collect())
}

fn main() -> Result<(), GeneratorError> {
    let encounters = cut_ins()?;
    let share = |count: usize| 100.0 * count as f64 / encounters.len() as f64;
    println!("{} cut-ins", encounters.len());
    println!("driver   collisions   front    side    rear   at its own fault   mean impact   time");
    let ideal: Vec<Ended> = encounters.iter().map(reference::ALL[4].1).collect();
    let unbraked: (&str, reference::Drive) = ("none", |encounter| encounter.run(&Unbraked));
    for (name, outcome) in std::iter::once(unbraked).chain(reference::ALL) {
        let started = Instant::now();
        let ended: Vec<Ended> = encounters.iter().map(outcome).collect();
        let seconds = started.elapsed().as_secs_f64();
        let collisions: Vec<_> = ended.iter().filter_map(|ended| ended.collision).collect();
        let with = |face: Face| share(collisions.iter().filter(|collision| collision.face == face).count());
        let own = ended.iter().zip(&ideal).filter(|(own, ideal)| own.collision.is_some() && ideal.collision.is_none());
        let mean = collisions.iter().map(|collision| collision.speed).sum::<f64>() / collisions.len() as f64;
        println!(
            "{name:<8} {:>8.2} %  {:>5.2} % {:>5.2} % {:>5.2} %   {:>12.2} %   {mean:>7.2} m/s   {seconds:.3} s",
            share(collisions.len()),
            with(Face::Front),
            with(Face::Side),
            with(Face::Rear),
            share(own.count()),
        );
    }
    Ok(())
}
