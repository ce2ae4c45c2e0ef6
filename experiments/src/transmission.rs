//! The automatic transmission benchmark: a car with a four-speed automatic, its inputs throttle and brake.
//!
//! Hoxha, Abbas and Fainekos, "Benchmarks for temporal logic requirements for automotive systems", ARCH 2014, took the
//! model from the Simulink example "Modeling an Automatic Transmission Controller"; it is the benchmark AT of the
//! falsification tools' yearly comparison (ARCH-COMP). These are its equations, written anew:
//!
//! | what | equation |
//! | --- | --- |
//! | engine | `I_e dω_e/dt = T_e(θ, ω_e) - T_i`, with ω_e from 600 to 6,000 rpm |
//! | torque converter | `T_i = (ω_e / K(s))²`, `T_t = R(s) T_i`, with the speed ratio `s = ω_t / ω_e` |
//! | gears | `ω_t = G_g F ω_w`, `T_w = G_g F T_t`, with `G` = 2.393, 1.450, 1.000, 0.677 and the final drive `F` = 3.23 |
//! | vehicle | `I_v dω_w/dt = T_w - (T_0 + c v² + T_brake)`, `v = r ω_w`; it does not roll backwards |
//! | shifts | up where `v > U_g(θ)`, down where `v < D_g(θ)`, each when that has been so for 0.08 s |
//!
//! Inertias, gears, final drive, wheel radius, road load and the delay are those of the example, in SI units. What
//! differs from it:
//!
//! - The tables are smooth functions of ours: the engine's torque `T_e` (a parabola over the speed at full throttle, less
//!   of it at part throttle and the higher the speed the less, and a governor that holds the idle speed), the converter's
//!   capacity `1/K²` and torque ratio `R`, the shift speeds `U_g` and `D_g` (a smooth step over the throttle between
//!   the ends of the table). The example's engine has no governor and falls to 600 rpm.
//! - The engine's greatest torque is not the table's, but such that full throttle is a little above 120 mph after 20 s, as
//!   published results on the benchmark have it: that `speed < 120` is violated by hardly anything else.
//! - Beyond a speed ratio of 1 the converter turns the engine; the example's tables end at 0.94.
//! - Classical Runge-Kutta with a fixed step of 0.02 s, between two of which the gear may change; Simulink chooses its
//!   steps itself. Nothing but the four operations is used, so that results are the same on every machine.

/// How many samples of the outputs there are in a second.
pub const SAMPLES_PER_SECOND: f64 = 10.0;

const STEPS_PER_SAMPLE: usize = 5;
const STEP: f64 = 1.0 / SAMPLES_PER_SECOND / STEPS_PER_SAMPLE as f64;
/// In a test, which takes 30 s.
const STEPS: usize = 1500;

/// Radians per second in a revolution per minute.
const RPM: f64 = std::f64::consts::TAU / 60.0;
/// Metres per second in a mile per hour.
const MPH: f64 = 0.44704;
/// Newton metres in a pound-foot.
const POUND_FOOT: f64 = 1.355_817_948;

const GEARS: [f64; 4] = [2.393, 1.450, 1.000, 0.677];
const FINAL_DRIVE: f64 = 3.23;
/// In metres: a foot.
const WHEEL_RADIUS: f64 = 0.3048;
/// In kg m²; the example has 0.021991 lb ft per rpm/s.
const ENGINE_INERTIA: f64 = 0.021_991_488 * POUND_FOOT / RPM;
/// In kg m²; the example has 12.094151 lb ft per rpm/s, which is that of a car of 1,685 kg.
const VEHICLE_INERTIA: f64 = 12.094_151 * POUND_FOOT / RPM;
const ROLLING: f64 = 40.0 * POUND_FOOT;
/// In N m per (m/s)².
const DRAG: f64 = 0.02 * POUND_FOOT / (MPH * MPH);

const SLOWEST: f64 = 600.0 * RPM;
const FASTEST: f64 = 6000.0 * RPM;
const IDLE: f64 = 1000.0 * RPM;

/// At full throttle, in N m, and the speed at which that is so.
const MOST_TORQUE: f64 = 445.0;
const MOST_TORQUE_AT: f64 = 4000.0 * RPM;
/// How far from there there would be none.
const TORQUE_WIDTH: f64 = 5200.0 * RPM;

/// The converter's capacity at standstill: K is 137 rpm per root of a pound-foot, as in the example.
const CAPACITY: f64 = POUND_FOOT / (137.0 * RPM * 137.0 * RPM);

/// How long it takes to change gear, in steps.
const SHIFT_DELAY: u32 = 4;

/// What a sample of a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// In miles per hour.
    pub speed: f64,
    /// Of the engine, in revolutions per minute.
    pub rpm: f64,
    /// From 1 to 4.
    pub gear: usize,
}

/// Runs a test: throttle in percent and brake torque in pound-feet, each constant over as many equal parts of the run as
/// there are values.
///
/// # Panics
/// One of them has no value.
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

/// The state.
struct Car {
    /// In rad/s.
    engine: f64,
    /// In rad/s.
    wheel: f64,
    /// From 0.
    gear: usize,
    /// The gear that the shift logic asks for, and for how many steps it has.
    wish: usize,
    waited: u32,
}

impl Car {
    fn sample(&self) -> Sample {
        let speed = self.wheel * WHEEL_RADIUS / MPH;
        Sample { speed, rpm: self.engine / RPM, gear: self.gear + 1 }
    }

    /// A step with throttle from 0 to 1 and brake in N m.
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

/// The accelerations of engine and wheels, in rad/s².
fn slope(engine: f64, wheel: f64, ratio: f64, throttle: f64, brake: f64) -> [f64; 2] {
    let engine = engine.max(SLOWEST);
    let speed_ratio = wheel.max(0.0) * ratio / engine;
    let impeller = CAPACITY * engine * engine * capacity(speed_ratio);
    let turbine = impeller * torque_ratio(speed_ratio);
    let speed = wheel * WHEEL_RADIUS;
    let load = ROLLING + DRAG * speed * speed + brake;
    let wheel_torque = turbine * ratio - load;
    // What resists does not push.
    let wheel_torque = if wheel <= 0.0 { wheel_torque.max(0.0) } else { wheel_torque };
    [(engine_torque(throttle, engine) - impeller) / ENGINE_INERTIA, wheel_torque / VEHICLE_INERTIA]
}

/// In N m.
fn engine_torque(throttle: f64, engine: f64) -> f64 {
    let off = (engine - MOST_TORQUE_AT) / TORQUE_WIDTH;
    let open = MOST_TORQUE * (1.0 - off * off);
    // The governor gives what the converter takes at standstill and less by 1 N m for each rad/s, down to the drag.
    let governor = CAPACITY * IDLE * IDLE - (engine - IDLE);
    let closed = governor.clamp(-20.0 - 0.1 * engine, 120.0);
    // The faster the engine the more throttle it takes for the same share of air.
    let choke = 0.35 * engine / MOST_TORQUE_AT;
    let air = throttle / (throttle + choke * (1.0 - throttle));
    closed + (open - closed) * if throttle > 0.0 { air } else { 0.0 }
}

/// The converter's capacity as a share of that at standstill; negative where the turbine is the faster.
fn capacity(speed_ratio: f64) -> f64 {
    let square = speed_ratio * speed_ratio;
    (1.0 - square * square * speed_ratio).max(-1.0)
}

/// By how much the converter multiplies torque: 2.23 at standstill, 1 from the coupling point on.
fn torque_ratio(speed_ratio: f64) -> f64 {
    1.0 + 1.23 * (1.0 - speed_ratio / 0.86).max(0.0)
}

/// Above which speed in mph a gear, from 0, gives way to the next.
fn up_speed(gear: usize, throttle: f64) -> f64 {
    const AT_CLOSED: [f64; 3] = [10.0, 30.0, 50.0];
    const MORE_AT_OPEN: [f64; 3] = [30.0, 40.0, 50.0];
    AT_CLOSED[gear] + MORE_AT_OPEN[gear] * smooth_step((throttle - 0.25) / 0.65)
}

/// Below which speed in mph a gear, from 1, gives way to the one before.
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
        // In first gear, where nothing but the integration decides: two seconds by Euler's method.
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
