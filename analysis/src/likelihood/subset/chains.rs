//! Defines populations of tests at a level, and the chains that make them grow.

use crate::likelihood::monte_carlo::BATCH;
use crate::likelihood::{Runs, Tally, is_failure};
use crate::statistics::random::SplitMix64;
use paracosm_campaign::Error;
use paracosm_space::distribution::normal_cdf;

/// A test with independent standard normal coordinates and a robustness.
#[derive(Clone)]
pub(super) struct Member {
    place: Vec<f64>,
    pub robustness: f64,
}

/// A set of tests that could be judged.
pub(super) struct Population(pub Vec<Member>);

impl Population {
    /// Runs `size` independent tests at random places. Returns the judged tests, and the counts of all tests.
    pub fn independent(
        size: usize,
        dims: usize,
        runs: &mut Runs,
        random: &mut SplitMix64,
    ) -> Result<(Self, Tally), Error> {
        let (mut members, mut tally) = (Vec::with_capacity(size), Tally::default());
        while tally.tests < size {
            let batch = BATCH.min(size - tally.tests);
            let places: Vec<Vec<f64>> = (0..batch).map(|_| (0..dims).map(|_| random.normal()).collect()).collect();
            let values = judge(&places, runs)?;
            tally.add(Tally::of(&values));
            let judged = places.into_iter().zip(values);
            members.extend(judged.filter_map(|(place, value)| Some(Member { place, robustness: value? })));
        }
        if members.is_empty() {
            tally.share()?;
        }
        Ok((Self(members), tally))
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns the tests whose robustness is at most `threshold`.
    pub fn below(self, threshold: f64) -> Vec<Member> {
        self.0.into_iter().filter(|member| reaches(member.robustness, threshold)).collect()
    }

    pub fn failures(&self) -> usize {
        self.0.iter().filter(|member| is_failure(member.robustness)).count()
    }
}

/// Returns `true` if a robustness is at most the threshold of a level. The sign of a zero matters here, because it
/// decides the verdict.
pub(super) fn reaches(robustness: f64, threshold: f64) -> bool {
    robustness.total_cmp(&threshold).is_le()
}

fn judge(places: &[Vec<f64>], runs: &mut Runs) -> Result<Vec<Option<f64>>, Error> {
    let points: Vec<Vec<f64>> = places.iter().map(|place| place.iter().map(|z| normal_cdf(*z)).collect()).collect();
    runs.run(&points)
}

/// Makes a population of `size` tests at a level from the seeds, each of which begins a chain that stays at the level.
///
/// A chain steps by conditional sampling (Papaioannou, Betz, Zwirglmaier and Straub, MCMC algorithms for subset
/// simulation, Probabilistic Engineering Mechanics 41, 2015). The proposed place is the sum of the current place and
/// a new normal one, weighted so that it is normal again; the chain moves there if the proposed test is at the level.
/// All chains take a step together. `step` receives the share of the chains that moved in the last step (`None`
/// before the first step), and returns the size of the next step.
pub(super) fn grow(
    seeds: Vec<Member>,
    size: usize,
    threshold: f64,
    mut step: impl FnMut(Option<f64>) -> f64,
    runs: &mut Runs,
    random: &mut SplitMix64,
) -> Result<Population, Error> {
    let mut heads = shuffled(seeds, random);
    let mut members = heads.clone();
    let mut moved = None;
    while members.len() < size {
        // The lengths of chains differ by one at most. The longer chains are chosen at random.
        heads.truncate(size - members.len());
        let far = step(moved);
        let keep = (1.0 - far * far).sqrt();
        let propose = |head: &Member| head.place.iter().map(|z| keep * z + far * random.normal()).collect();
        let places: Vec<Vec<f64>> = heads.iter().map(propose).collect();
        let values = judge(&places, runs)?;
        let mut accepted = 0;
        for ((head, place), value) in heads.iter_mut().zip(places).zip(values) {
            if let Some(robustness) = value.filter(|robustness| reaches(*robustness, threshold)) {
                *head = Member { place, robustness };
                accepted += 1;
            }
        }
        moved = Some(accepted as f64 / heads.len() as f64);
        members.extend(heads.iter().cloned());
    }
    Ok(Population(members))
}

fn shuffled(mut members: Vec<Member>, random: &mut SplitMix64) -> Vec<Member> {
    for i in (1..members.len()).rev() {
        members.swap(i, random.below(i + 1));
    }
    members
}
