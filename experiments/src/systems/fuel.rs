//! The benchmark AFC: the control of fuel in an engine, whose inputs are the pedal and the engine speed.
//!
//! Jin, Deshmukh, Kapinski, Ueda and Butts, "Powertrain control verification benchmark", HSCC 2014. This is the first model of the paper, the model
//! that ARCH-COMP uses, with all its tables and constants:
//!
//! | what | equation |
//! | --- | --- |
//! | throttle | `ds/dt = pedal - 10 s`, `θ = 10 s + 8.8`, from 0 to 90 degrees |
//! | air into the manifold | `m_in = f(θ) g(p) sgn(1 - p)`, `dp/dt = 0.41328 (m_in - m_out)`, `m_out` from `p` and the engine speed |
//! | fuel | a share `κ` of the injected fuel goes into the cylinder, the rest into a puddle, which evaporates with the time constant `τ` |
//! | measured air per fuel | the quotient, late by a variable transport delay, then through two lags of 0.1 s and 0.02 s |
//! | controller | each 10 ms, in single precision: an estimate of `p`, feed-forward, and a PI feedback after 10 s outside of power mode |
//!
//! The sensor does not fail before the end. With an open throttle the pressure follows much faster than a step of 5 ms allows, so that an
//! explicit method would jump around the solution. The pressure is therefore integrated by a second-order, L-stable method (R. Alexander,
//! "Diagonally implicit Runge-Kutta methods for stiff O.D.E.'s", 1977), the throttle exactly, and the rest by classical Runge-Kutta.

use super::{Input, Recorder, advance, table2};

/// The sample period in seconds.
pub const PERIOD: f64 = 0.01;
const STEP: f64 = 0.005;
const STEPS: usize = 10_000;
/// The controller and the samples have the same period.
const STEPS_PER_TICK: usize = 2;

/// The ratio of air and fuel in normal mode, and in power mode.
const NORMAL: f32 = 14.7;
const POWER: f32 = 12.5;

const SPEEDS: [f64; 5] = [1000.0, 1500.0, 2000.0, 2500.0, 3000.0];
const CHARGES: [f64; 4] = [0.1, 0.2, 0.3, 0.4];
/// The share of the fuel that goes into the cylinder: a row for each charge, a column for each engine speed in rpm.
const SHARE: [[f64; 5]; 4] = [
    [0.8, 0.7, 0.7, 0.8, 0.9],
    [0.7, 0.66, 0.65, 0.73, 0.85],
    [0.66, 0.66, 0.63, 0.66, 0.8],
    [0.6, 0.6, 0.6, 0.6, 0.7],
];
/// The time constant of the puddle in seconds.
const EVAPORATION: [[f64; 5]; 4] = [
    [0.4, 0.3, 0.35, 0.3, 0.2],
    [0.22, 0.22, 0.4, 0.35, 0.5],
    [0.2, 0.22, 0.5, 0.4, 0.35],
    [0.35, 0.3, 0.45, 0.5, 0.4],
];
const DELAY_SPEEDS: [f64; 5] = [800.0, 1000.0, 1500.0, 2000.0, 3000.0];
const DELAY_CHARGES: [f64; 4] = [0.05, 0.15, 0.2, 0.25];
/// The transport delay in seconds.
const DELAY: [[f64; 5]; 4] =
    [[0.8, 0.6, 0.4, 0.3, 0.2], [0.4, 0.3, 0.2, 0.2, 0.2], [0.3, 0.25, 0.2, 0.2, 0.2], [0.25, 0.2, 0.2, 0.2, 0.2]];

/// The places of the continuous states behind the manifold.
const PUDDLE: usize = 0;
/// The integral of the reciprocal of the delay. What enters now comes out when it has grown by one.
const TRANSPORT: usize = 1;
const EXHAUST: usize = 2;
const SENSOR: usize = 3;

/// Runs a test with the pedal in degrees and the engine speed in rpm. Records the pedal, the relative error of the ratio of air and fuel, and 1 in
/// normal mode or 0 in startup and power mode.
pub fn run(inputs: &[Input], record: &mut Recorder) {
    let mut manifold = Manifold { throttle: 0.0, pressure: 0.982 };
    let mut state = [0.0112, 0.0, f64::from(NORMAL), f64::from(NORMAL)];
    let mut controller = Controller::new();
    let mut line = Line::default();
    let decay = Decay::new();
    for step in 0..=STEPS {
        let [pedal, rpm] = [&inputs[0], &inputs[1]].map(|input| input.at(step, STEPS));
        let omega = rpm.clamp(900.0, 3100.0) * std::f64::consts::TAU / 60.0;
        if step % STEPS_PER_TICK == 0 {
            if step > 0 {
                let opening = opening(manifold.throttle);
                let air = inflow(opening, manifold.pressure);
                controller.tick(opening as f32, omega as f32, air as f32, state[SENSOR] as f32);
            }
            let reference = f64::from(controller.reference);
            record(&[pedal, (state[SENSOR] - reference) / reference, f64::from(u8::from(!controller.is_open_loop))]);
        }
        let fuel = f64::from(controller.fuel);
        // As in the model, what enters the pipe is a straight line from step to step, also where the fuel jumps.
        line.push(state[TRANSPORT], Mixture::of(state[PUDDLE], manifold.pressure, omega, fuel).ratio);
        let next = manifold.after(pedal, omega, &decay);
        let late = &mut line;
        state = advance(state, STEP, |share, state| {
            let pressure = manifold.pressure + (next.pressure - manifold.pressure) * share;
            slope(&state, pressure, omega, fuel, late)
        });
        manifold = next;
    }
}

/// Returns the opening of the throttle in degrees.
fn opening(throttle: f64) -> f64 {
    (10.0 * throttle + 8.8).clamp(0.0, 90.0)
}

/// Returns the flow of air into the manifold in g/s.
fn inflow(angle: f64, pressure: f64) -> f64 {
    let area = 2.821 - 0.05231 * angle + 0.10299 * angle * angle - 0.00063 * angle * angle * angle;
    let ratio = pressure.min(1.0 / pressure);
    let share = if ratio >= 0.5 { 2.0 * (ratio - ratio * ratio).max(0.0).sqrt() } else { 1.0 };
    let direction = if pressure == 1.0 { 0.0 } else { (1.0 - pressure).signum() };
    area * share * direction
}

/// Returns the flow of air out of the manifold, into the cylinders, in g/s.
fn outflow(pressure: f64, omega: f64) -> f64 {
    -0.366 + 0.08979 * pressure * omega - 0.0337 * omega * pressure * pressure + 0.0001 * pressure * omega * omega
}

/// Air and fuel in the cylinders.
struct Mixture {
    /// The air in a stroke, the charge, in g.
    charge: f64,
    rpm: f64,
    share: f64,
    evaporated: f64,
    /// The ratio of air and fuel.
    ratio: f64,
}

impl Mixture {
    fn of(puddle: f64, pressure: f64, omega: f64, fuel: f64) -> Self {
        let air = outflow(pressure, omega);
        let charge = air / omega * std::f64::consts::PI;
        let rpm = omega * 60.0 / std::f64::consts::TAU;
        let share = table2(&CHARGES, &SPEEDS, |row, column| SHARE[row][column], charge, rpm);
        let time = table2(&CHARGES, &SPEEDS, |row, column| EVAPORATION[row][column], charge, rpm);
        let evaporated = puddle / time;
        Self { charge, rpm, share, evaporated, ratio: air / (share * fuel + evaporated) }
    }
}

/// Returns the slopes of the states behind the manifold.
fn slope(state: &[f64; 4], pressure: f64, omega: f64, fuel: f64, late: &mut Line) -> [f64; 4] {
    let mixture = Mixture::of(state[PUDDLE], pressure, omega, fuel);
    let (rpm, charge) = (mixture.rpm, mixture.charge);
    let delay = table2(&DELAY_CHARGES, &DELAY_SPEEDS, |row, column| DELAY[row][column], charge, rpm).min(10.0);
    let mut slope = [0.0; 4];
    slope[PUDDLE] = (1.0 - mixture.share) * fuel - mixture.evaporated;
    slope[TRANSPORT] = if delay < 0.0 { 0.0 } else { 1.0 / delay };
    slope[EXHAUST] = 10.0 * (late.out(state[TRANSPORT]) - state[EXHAUST]);
    slope[SENSOR] = 50.0 * (state[EXHAUST] - state[SENSOR]);
    slope
}

/// The throttle, and the pressure behind it.
#[derive(Clone, Copy)]
struct Manifold {
    throttle: f64,
    /// The pressure in bar.
    pressure: f64,
}

/// The shares of its distance from the end that the throttle keeps for the stages of a step.
struct Decay([f64; 2]);

/// The place of the first stage of the implicit method: 1 - 1/√2.
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

impl Decay {
    fn new() -> Self {
        Self([GAMMA, 1.0].map(|share| libm::exp(-10.0 * STEP * share)))
    }
}

impl Manifold {
    /// Returns the state after a step.
    fn after(self, pedal: f64, omega: f64, decay: &Decay) -> Self {
        let end = pedal / 10.0;
        let throttles = decay.0.map(|kept| end + (self.throttle - end) * kept);
        let step = GAMMA * STEP;
        let first = solved(self.pressure, step, opening(throttles[0]), omega);
        let slope = (first - self.pressure) / step;
        let from = self.pressure + (1.0 - GAMMA) * STEP * slope;
        Self { throttle: throttles[1], pressure: solved(from, step, opening(throttles[1]), omega) }
    }
}

/// Solves `p = from + step p'(p)`, where the slope `p'` falls with the pressure below 1. Newton's method is kept within a bracket.
fn solved(from: f64, step: f64, angle: f64, omega: f64) -> f64 {
    let excess = |p: f64| p - from - step * 0.41328 * (inflow(angle, p) - outflow(p, omega));
    let (mut low, mut high) = (1e-3, 1.0);
    let mut p = from.clamp(low, high);
    for _ in 0..60 {
        let value = excess(p);
        if value > 0.0 {
            high = p;
        } else {
            low = p;
        }
        let small = 1e-7 * (1.0 - p).max(1e-9);
        let slope = (excess(p - small) - value) / -small;
        let newton = p - value / slope;
        let next = if newton > low && newton < high { newton } else { f64::midpoint(low, high) };
        if (next - p).abs() <= 1e-15 {
            return next;
        }
        p = next;
    }
    p
}

/// The pipe between the engine and the sensor: what entered, with the value of the transport state at that time.
#[derive(Default)]
struct Line {
    entered: Vec<(f64, f64)>,
    /// The number of entries that have come out.
    out: usize,
}

impl Line {
    fn push(&mut self, transport: f64, ratio: f64) {
        self.entered.push((transport, ratio));
    }

    /// Returns the ratio that comes out when the transport state has the given value.
    fn out(&mut self, transport: f64) -> f64 {
        let place = transport - 1.0;
        while self.entered.get(self.out).is_some_and(|entry| entry.0 <= place) {
            self.out += 1;
        }
        // An earlier stage of the same step may ask for a place a little further back.
        while self.out > 0 && self.entered[self.out - 1].0 > place {
            self.out -= 1;
        }
        match (self.out.checked_sub(1).map(|before| self.entered[before]), self.entered.get(self.out)) {
            (Some(before), Some(after)) => {
                before.1 + (after.1 - before.1) * ((place - before.0) / (after.0 - before.0))
            }
            (Some(last), None) => last.1,
            (None, _) => f64::from(NORMAL),
        }
    }
}

/// The controller, in single precision as in the model.
struct Controller {
    /// The estimate of the pressure.
    pressure: f32,
    integral: f32,
    seconds: f32,
    has_started: bool,
    is_powerful: bool,
    /// `true` without feedback: while the engine starts, and in power mode.
    is_open_loop: bool,
    reference: f32,
    /// The fuel that is injected, in g/s.
    fuel: f32,
}

impl Controller {
    fn new() -> Self {
        Self {
            pressure: 0.982,
            integral: 0.0,
            seconds: 0.0,
            has_started: false,
            is_powerful: false,
            is_open_loop: true,
            reference: NORMAL,
            fuel: 0.1726,
        }
    }

    fn tick(&mut self, opening: f32, omega: f32, air: f32, measured: f32) {
        self.seconds += 0.01;
        self.has_started |= self.seconds >= 10.0;
        self.is_powerful = opening >= if self.is_powerful { 50.0 } else { 70.0 };
        self.is_open_loop = !self.has_started || self.is_powerful;
        self.reference = if self.has_started && self.is_powerful { POWER } else { NORMAL };

        let pressure = self.pressure;
        let out = pressure * omega * 0.08979 - 0.366 - pressure * pressure * omega * 0.0337
            + omega * omega * pressure * 0.0001;
        self.pressure += (air - out) * 0.41328 * 0.01;
        let feedback = if self.is_open_loop {
            1.0
        } else {
            let error = measured - self.reference;
            self.integral += 0.14 * error * 0.01;
            (1.0 + (0.04 * error + self.integral)).max(0.0)
        };
        self.fuel = (feedback * (out / self.reference)).clamp(0.13, 1.66);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(pedal: Vec<f64>, rpm: f64) -> Vec<[f64; 3]> {
        let mut rows = Vec::new();
        run(&[Input::new(pedal), Input::new(vec![rpm])], &mut |row| rows.push([row[0], row[1], row[2]]));
        rows
    }

    #[test]
    fn it_starts_in_ten_seconds_and_then_holds_the_ratio() {
        let rows = rows(vec![20.0], 1000.0);
        assert_eq!(rows.len(), 5001);
        let normal = rows.iter().position(|row| row[2] == 1.0).unwrap() as f64 * PERIOD;
        assert!((9.9..10.1).contains(&normal), "{normal}");
        assert!(rows[4000..].iter().all(|row| row[1].abs() < 1e-3), "{:?}", rows[5000]);
    }

    #[test]
    fn a_step_of_the_pedal_disturbs_the_ratio_for_some_seconds() {
        let rows = rows(vec![0.0, 0.0, 61.0, 61.0, 61.0], 1100.0);
        let most = |from: f64, to: f64| {
            let range = (from / PERIOD) as usize..(to / PERIOD) as usize;
            rows[range].iter().map(|row| row[1].abs()).fold(0.0, f64::max)
        };
        assert!((0.0065..0.0075).contains(&most(20.0, 22.0)), "{}", most(20.0, 22.0));
        assert!(most(45.0, 50.0) < 1e-4, "{}", most(45.0, 50.0));
    }

    #[test]
    fn smaller_steps_of_the_pressure_come_to_the_same_end() {
        // A wide throttle makes the pressure follow within a tenth of a millisecond.
        let decay = Decay::new();
        let mut manifold = Manifold { throttle: 0.0, pressure: 0.982 };
        let (mut throttle, mut pressure) = (0.0, 0.982);
        for _ in 0..40 {
            manifold = manifold.after(61.0, 110.0, &decay);
            for _ in 0..20_000 {
                let small = STEP / 20_000.0;
                throttle += small * (61.0 - 10.0 * throttle);
                pressure += small * 0.41328 * (inflow(opening(throttle), pressure) - outflow(pressure, 110.0));
            }
        }
        assert!((manifold.throttle - throttle).abs() < 1e-4, "{} {throttle}", manifold.throttle);
        assert!((manifold.pressure - pressure).abs() < 1e-6, "{} {pressure}", manifold.pressure);
        let balance = inflow(opening(manifold.throttle), manifold.pressure) - outflow(manifold.pressure, 110.0);
        assert!(balance.abs() < 0.05, "{balance}");
    }

    #[test]
    fn a_wide_throttle_asks_for_power() {
        let rows = rows(vec![70.0], 1000.0);
        assert!(rows[2000..].iter().all(|row| row[2] == 0.0));
        assert!(rows[4900][1].abs() < 0.05, "{:?}", rows[4900]);
    }

    #[test]
    fn what_enters_the_pipe_comes_out_after_the_delay() {
        let mut line = Line::default();
        for step in 0..400 {
            let time = f64::from(step) * 0.005;
            line.push(time / 0.5, time);
        }
        assert_eq!(line.out(0.3), f64::from(NORMAL));
        assert!((line.out(2.0) - 0.5).abs() < 1e-12 && (line.out(1.5) - 0.25).abs() < 1e-12);
    }
}
