//! The benchmark CC: five cars in a row, of which the first is driven by the test and each other follows the car before it.
//!
//! Hu, Lygeros and Sastry, "Towards a theory of stochastic hybrid systems", HSCC 2000, have such a row of cars; the benchmark of ARCH-COMP is this
//! version of it, with all its constants:
//!
//! | what | equation |
//! | --- | --- |
//! | first car | `dv/dt = -throttle - brake v`, `dx/dt = v`, from `x = 0` |
//! | a car that chases | `dv/dt = 1`, `dx/dt = -v`, until the gap is at most 10: then it keeps |
//! | a car that keeps | `dv/dt = 0`, `dx/dt = v`, until the gap is at least 15: then it chases; or at most 5: then it brakes |
//! | a car that brakes | `dv/dt = -v`, `dx/dt = -v`, until the gap is at least 20: then it chases |
//!
//! The cars drive towards negative `x`, except that a car that keeps moves away from the car before it at its own speed, as in the benchmark. The
//! gap of car i is `x_i - x_(i-1)`; it is 10 at first. All cars stand at first, and the others keep. The modes change at the ends of steps of 0.01 s,
//! while Simulink looks for the instant itself; within a step the motion of the followers is exact.

use super::{Input, Recorder};

/// The sample period in seconds.
pub const PERIOD: f64 = 0.1;
const STEP: f64 = 0.01;
const STEPS: usize = 10_000;
const STEPS_PER_SAMPLE: usize = 10;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Chases,
    Keeps,
    Brakes,
}

#[derive(Clone, Copy)]
struct Follower {
    x: f64,
    v: f64,
    mode: Mode,
}

impl Follower {
    /// Changes the mode, given the gap at this instant.
    fn decide(&mut self, gap: f64) {
        self.mode = match self.mode {
            Mode::Chases if gap <= 10.0 => Mode::Keeps,
            Mode::Keeps if gap >= 15.0 => Mode::Chases,
            Mode::Keeps if gap <= 5.0 => Mode::Brakes,
            Mode::Brakes if gap >= 20.0 => Mode::Chases,
            same => same,
        };
    }

    /// Moves the car by a step. `decay` is the share of its speed that a car keeps that brakes for a step.
    fn advance(&mut self, decay: f64) {
        match self.mode {
            Mode::Chases => {
                self.x -= self.v * STEP + STEP * STEP / 2.0;
                self.v += STEP;
            }
            Mode::Keeps => self.x += self.v * STEP,
            Mode::Brakes => {
                self.x -= self.v * (1.0 - decay);
                self.v *= decay;
            }
        }
    }
}

/// Runs a test with throttle and brake from 0 to 1. Records the positions of the five cars, from the first to the last.
pub fn run(inputs: &[Input], record: &mut Recorder) {
    let decay = libm::exp(-STEP);
    let mut first = [0.0, 0.0];
    let mut followers = [10.0, 20.0, 30.0, 40.0].map(|x| Follower { x, v: 0.0, mode: Mode::Keeps });
    for step in 0..=STEPS {
        if step % STEPS_PER_SAMPLE == 0 {
            record(&[first[0], followers[0].x, followers[1].x, followers[2].x, followers[3].x]);
        }
        let mut before = first[0];
        for car in &mut followers {
            let x = car.x;
            car.decide(x - before);
            before = x;
        }
        let [throttle, brake] = [&inputs[0], &inputs[1]].map(|input| input.at(step, STEPS));
        first = super::advance(first, STEP, |_, [_, v]| [v, -throttle - brake * v]);
        followers.iter_mut().for_each(|car| car.advance(decay));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn positions(throttle: f64, brake: f64) -> Vec<[f64; 5]> {
        let mut rows = Vec::new();
        let inputs = [throttle, brake].map(|value| Input::new(vec![value]));
        run(&inputs, &mut |row| rows.push(row.try_into().unwrap()));
        rows
    }

    #[test]
    fn without_throttle_nobody_moves() {
        let rows = positions(0.0, 1.0);
        assert_eq!(rows.len(), 1001);
        assert!(rows.iter().all(|row| *row == [0.0, 10.0, 20.0, 30.0, 40.0]));
    }

    #[test]
    fn a_follower_chases_keeps_and_brakes_at_the_gaps_of_the_benchmark() {
        let mut car = Follower { x: 0.0, v: 1.0, mode: Mode::Keeps };
        let modes = [14.9, 15.0, 10.1, 10.0, 5.1, 5.0, 19.9, 20.0].map(|gap| {
            car.decide(gap);
            car.mode
        });
        use Mode::{Brakes, Chases, Keeps};
        assert_eq!(modes, [Keeps, Chases, Chases, Keeps, Keeps, Brakes, Brakes, Chases]);
    }

    #[test]
    fn the_first_car_moves_as_its_equation_says() {
        // Without brake it falls by t²/2. With throttle and brake of 1 its speed is e^(-t) - 1.
        let at = |rows: &[[f64; 5]], seconds: usize| rows[seconds * 10][0];
        assert!((at(&positions(1.0, 0.0), 100) + 5000.0).abs() < 1e-6);
        let expected = 1.0 - libm::exp(-10.0) - 10.0;
        assert!((at(&positions(1.0, 1.0), 10) - expected).abs() < 1e-8);
    }
}
