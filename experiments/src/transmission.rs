//! A model of an automatic transmission: a car with four automatic gears, whose inputs are throttle and brake.
//!
//! Hoxha, Abbas and Fainekos, "Benchmarks for temporal logic requirements for automotive systems", ARCH 2014, took the
//! model from the Simulink example "Modeling an Automatic Transmission Controller". The benchmark AT of the
//! yearly comparison of falsification tools (ARCH-COMP) comes from the same example. This module is a model of our own with
//! these equations; its results are not those of the benchmark:
//!
//! | what | equation |
//! | --- | --- |
//! | engine | `I_e dω_e/dt = T_e(θ, ω_e) - T_i`, with ω_e from 600 to 6,000 rpm |
//! | torque converter | `T_i = (ω_e / K(s))²`, `T_t = R(s) T_i`, with the speed ratio `s = ω_t / ω_e` |
//! | gears | `ω_t = G_g F ω_w`, `T_w = G_g F T_t`, with `G` = 2.393, 1.450, 1.000, 0.677 and the final drive `F` = 3.23 |
//! | vehicle | `I_v dω_w/dt = T_w - (T_0 + c v² + T_brake)`, `v = r ω_w`; it does not roll backwards |
//! | shifts | up where `v > U_g(θ)`, down where `v < D_g(θ)`, each when that has been so for 0.08 s |
//!
//! Inertias, gears, final drive, wheel radius, road load and the delay are those of the example, in SI units. The
//! differences from the example are these:
//!
//! - Our own smooth functions replace the tables. The engine's torque `T_e` is a parabola over the speed at full
//!   throttle; at part throttle it is less, and the less the higher the speed is; a governor holds the idle speed.
//!   Smooth functions also replace the converter's capacity `1/K²` and torque ratio `R`, and the shift speeds `U_g` and
//!   `D_g` (a smooth step over the throttle between the ends of the table). The example's engine has no governor and
//!   falls to 600 rpm.
//! - The engine's greatest torque is not that of the table. It is chosen so that full throttle leads to a little above
//!   120 mph after 20 s, in agreement with published results on the benchmark: hardly anything but full throttle
//!   violates `speed < 120`.
//! - Above a speed ratio of 1 the converter turns the engine. The example's tables end at 0.94.
//! - The integration is by classical Runge-Kutta with a fixed step of 0.02 s, and the gear may change between two
//!   steps. Simulink chooses its steps itself. Only the four basic operations are used, so that results are the same on
//!   every machine.

/// The number of samples of the outputs in a second.
pub const SAMPLES_PER_SECOND: f64 = 10.0;

const STEPS_PER_SAMPLE: usize = 5;
const STEP: f64 = 1.0 / SAMPLES_PER_SECOND / STEPS_PER_SAMPLE as f64;
/// The number of steps in a test, which takes 30 s.
const STEPS: usize = 1500;

/// Radians per second in a revolution per minute.
const RPM: f64 = std::f64::consts::TAU / 60.0;
/// Metres per second in a mile per hour.
const MPH: f64 = 0.44704;
/// Newton metres in a pound-foot.
const POUND_FOOT: f64 = 1.355_817_948;

const GEARS: [f64; 4] = [2.393, 1.450, 1.000, 0.677];
const FINAL_DRIVE: f64 = 3.23;
/// The radius of a wheel in metres: one foot.
const WHEEL_RADIUS: f64 = 0.3048;
/// The engine's moment of inertia in kg m²; the example has 0.021991 lb ft per rpm/s.
const ENGINE_INERTIA: f64 = 0.021_991_488 * POUND_FOOT / RPM;
/// The vehicle's inertia at the wheels in kg m²; the example has 12.094151 lb ft per rpm/s, which belongs to a car of
/// 1,685 kg.
const VEHICLE_INERTIA: f64 = 12.094_151 * POUND_FOOT / RPM;
const ROLLING: f64 = 40.0 * POUND_FOOT;
/// The drag, in N m per (m/s)².
const DRAG: f64 = 0.02 * POUND_FOOT / (MPH * MPH);

const SLOWEST: f64 = 600.0 * RPM;
const FASTEST: f64 = 6000.0 * RPM;
const IDLE: f64 = 1000.0 * RPM;

/// The greatest torque at full throttle in N m, and the engine speed with this torque.
const MOST_TORQUE: f64 = 445.0;
const MOST_TORQUE_AT: f64 = 4000.0 * RPM;
/// The distance from that engine speed at which the torque would be zero.
const TORQUE_WIDTH: f64 = 5200.0 * RPM;

/// The converter's capacity at standstill. K is 137 rpm per square root of a pound-foot, as in the example.
const CAPACITY: f64 = POUND_FOOT / (137.0 * RPM * 137.0 * RPM);

/// The number of steps that a change of gear takes.
const SHIFT_DELAY: u32 = 4;

/// A sample of the outputs of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The speed of the car, in miles per hour.
    pub speed: f64,
    /// The speed of the engine, in revolutions per minute.
    pub rpm: f64,
    /// The gear, from 1 to 4.
    pub gear: usize,
}

/// Runs a test with throttle in percent and brake torque in pound-feet. Each input is constant over equal parts of the
/// run, one part for each of its values.
///
/// # Panics
/// Panics if an input has no value.
pub fn run(throttle: &[f64], brake: &[f64]) -> Vec<Sample> {
    let mut car = Car { engine: IDLE, wheel: 0.0, gear: 0, wish: 0, waited: 0 };
    let mut samples = vec![car.sample()];
    for step in 0..STEPS {
        let at = |signal: &[f64]| signal[step * signal.len() / STEPS];
        car.advance(at(throttle) / 100.0, at(brake) * POUND_FOOT);
        if (step + 1) % STEPS_PER_SAMPLE == 0 {
            samples.push(car.sample());
        }
    }
    samples
}

/// The state of the car.
struct Car {
    /// The speed of the engine, in rad/s.
    engine: f64,
    /// The speed of the wheels, in rad/s.
    wheel: f64,
    /// The gear, counted from 0.
    gear: usize,
    /// The gear that the shift logic asks for; `waited` is the number of steps for which the logic has asked for it.
    wish: usize,
    waited: u32,
}

impl Car {
    fn sample(&self) -> Sample {
        let speed = self.wheel * WHEEL_RADIUS / MPH;
        Sample { speed, rpm: self.engine / RPM, gear: self.gear + 1 }
    }

    /// Advances the car by a step with throttle from 0 to 1 and brake in N m.
    fn advance(&mut self, throttle: f64, brake: f64) {
        self.shift(throttle);
        let ratio = GEARS[self.gear] * FINAL_DRIVE;
        let slope = |[engine, wheel]: [f64; 2]| slope(engine, wheel, ratio, throttle, brake);
        let from = [self.engine, self.wheel];
        let after = |slope: [f64; 2], time: f64| [from[0] + slope[0] * time, from[1] + slope[1] * time];
        let a = slope(from);
        let b = slope(after(a, STEP / 2.0));
        let c = slope(after(b, STEP / 2.0));
        let d = slope(after(c, STEP));
        let mean = |i: usize| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0;
        let [engine, wheel] = after([mean(0), mean(1)], STEP);
        (self.engine, self.wheel) = (engine.clamp(SLOWEST, FASTEST), wheel.max(0.0));
    }

    fn shift(&mut self, throttle: f64) {
        let speed = self.wheel * WHEEL_RADIUS / MPH;
        let wish = match self.gear {
            gear if gear < 3 && speed > up_speed(gear, throttle) => gear + 1,
            gear if gear > 0 && speed < down_speed(gear, throttle) => gear - 1,
            gear => gear,
        };
        self.waited = if wish == self.wish && wish != self.gear { self.waited + 1 } else { 0 };
        self.wish = wish;
        if self.waited >= SHIFT_DELAY {
            (self.gear, self.waited) = (wish, 0);
        }
    }
}

/// Returns the accelerations of the engine and of the wheels, in rad/s².
fn slope(engine: f64, wheel: f64, ratio: f64, throttle: f64, brake: f64) -> [f64; 2] {
    let engine = engine.max(SLOWEST);
    let speed_ratio = wheel.max(0.0) * ratio / engine;
    let impeller = CAPACITY * engine * engine * capacity(speed_ratio);
    let turbine = impeller * torque_ratio(speed_ratio);
    let speed = wheel * WHEEL_RADIUS;
    let load = ROLLING + DRAG * speed * speed + brake;
    let wheel_torque = turbine * ratio - load;
    // Resistance does not push the car backwards.
    let wheel_torque = if wheel <= 0.0 { wheel_torque.max(0.0) } else { wheel_torque };
    [(engine_torque(throttle, engine) - impeller) / ENGINE_INERTIA, wheel_torque / VEHICLE_INERTIA]
}

/// Returns the torque of the engine, in N m.
fn engine_torque(throttle: f64, engine: f64) -> f64 {
    let off = (engine - MOST_TORQUE_AT) / TORQUE_WIDTH;
    let open = MOST_TORQUE * (1.0 - off * off);
    // At idle speed the governor gives the torque that the converter takes at standstill; it gives 1 N m less for each
    // rad/s above idle speed, down to the engine's drag.
    let governor = CAPACITY * IDLE * IDLE - (engine - IDLE);
    let closed = governor.clamp(-20.0 - 0.1 * engine, 120.0);
    // The faster the engine, the more throttle is necessary for the same share of air.
    let choke = 0.35 * engine / MOST_TORQUE_AT;
    let air = throttle / (throttle + choke * (1.0 - throttle));
    closed + (open - closed) * if throttle > 0.0 { air } else { 0.0 }
}

/// Returns the converter's capacity as a share of its capacity at standstill; negative if the turbine is faster than
/// the engine.
fn capacity(speed_ratio: f64) -> f64 {
    let square = speed_ratio * speed_ratio;
    (1.0 - square * square * speed_ratio).max(-1.0)
}

/// Returns the factor by which the converter multiplies torque: 2.23 at standstill, 1 from the coupling point on.
fn torque_ratio(speed_ratio: f64) -> f64 {
    1.0 + 1.23 * (1.0 - speed_ratio / 0.86).max(0.0)
}

/// Returns the speed in mph above which a gear, counted from 0, gives way to the next gear.
fn up_speed(gear: usize, throttle: f64) -> f64 {
    const AT_CLOSED: [f64; 3] = [10.0, 30.0, 50.0];
    const MORE_AT_OPEN: [f64; 3] = [30.0, 40.0, 50.0];
    AT_CLOSED[gear] + MORE_AT_OPEN[gear] * smooth_step((throttle - 0.25) / 0.65)
}

/// Returns the speed in mph below which a gear, counted from 0, gives way to the gear before.
fn down_speed(gear: usize, throttle: f64) -> f64 {
    const AT_CLOSED: [f64; 3] = [5.0, 20.0, 35.0];
    const MORE_AT_OPEN: [f64; 3] = [25.0, 30.0, 45.0];
    let begin = if gear == 1 { 0.50 } else { 0.25 };
    AT_CLOSED[gear - 1] + MORE_AT_OPEN[gear - 1] * smooth_step((throttle - begin) / (0.90 - begin))
}

fn smooth_step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(samples: &[Sample], is: impl FnMut(&Sample) -> bool) -> f64 {
        samples.iter().position(is).map_or(f64::INFINITY, |at| at as f64 / SAMPLES_PER_SECOND)
    }

    #[test]
    fn full_throttle_is_just_above_120_mph_after_20_seconds_and_shifts_at_high_speeds() {
        let samples = run(&[100.0], &[0.0]);
        assert!((19.0..20.0).contains(&first(&samples, |sample| sample.speed >= 120.0)));
        let shifts = samples.windows(2).filter(|pair| pair[1].gear != pair[0].gear);
        let shifts: Vec<(usize, bool)> = shifts.map(|pair| (pair[1].gear, pair[0].rpm > 4500.0)).collect();
        assert_eq!(shifts, [(2, true), (3, true), (4, true)]);
    }

    #[test]
    fn without_throttle_it_creeps_and_the_brake_holds_it_for_good() {
        let held = run(&[0.0], &[20_000.0]);
        assert!(held.iter().all(|sample| sample.speed == 0.0 && (sample.rpm - 1000.0).abs() < 1.0));
        let creeping = run(&[0.0], &[0.0]);
        assert!((5.0..15.0).contains(&creeping[40].speed) && creeping.iter().all(|sample| sample.rpm < 1600.0));
    }

    #[test]
    fn more_throttle_is_faster_and_more_brake_is_slower() {
        let end = |throttle: f64, brake: f64| run(&[throttle], &[brake])[300].speed;
        let faster: Vec<f64> = (0..=10).map(|step| end(10.0 * f64::from(step), 0.0)).collect();
        assert!(faster.is_sorted(), "{faster:?}");
        assert!(end(50.0, 325.0) < end(50.0, 100.0) && end(50.0, 100.0) < end(50.0, 0.0));
    }

    #[test]
    fn the_steps_come_to_what_many_small_ones_do() {
        // In first gear, two seconds of the integration are compared with Euler's method.
        let (mut engine, mut wheel) = (IDLE, 0.0);
        for _ in 0..200_000 {
            let slope = slope(engine, wheel, GEARS[0] * FINAL_DRIVE, 1.0, 0.0);
            (engine, wheel) = (engine + slope[0] * 1e-5, wheel + slope[1] * 1e-5);
        }
        let sample = run(&[100.0], &[0.0])[20];
        assert_eq!(sample.gear, 1);
        assert!((sample.speed - wheel * WHEEL_RADIUS / MPH).abs() < 1e-3 && (sample.rpm - engine / RPM).abs() < 0.1);
    }
}
