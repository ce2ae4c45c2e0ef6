//! The benchmark F16: a fighter that pulls up before it hits the ground. The inputs are its roll, pitch and yaw at first.
//!
//! Heidlauf, Collins, Bolender and Bak, "Verification challenges in F-16 ground collision avoidance and other automated maneuvers", ARCH 2018. The
//! equations of motion and the engine come from Stevens and Lewis, "Aircraft control and simulation"; the aerodynamics are the polynomials of
//! Morelli, "Global nonlinear parametric modeling with application to F-16 aerodynamics", ACC 1998, with the damping terms of Stevens and Lewis added,
//! as in the benchmark. The controllers and all constants come from the benchmark. A run begins at 2,330 ft and 540 ft/s, in the mode that rolls the
//! wings level.
//!
//! Units are feet, seconds, slugs and radians; control surfaces are in degrees. The integration is by classical Runge-Kutta with steps of 1/240 s,
//! where the benchmark has an adaptive method; both decide on modes 30 times in a second.

use super::{Input, Recorder, advance, table, table2};
use std::f64::consts::TAU;

/// The sample period in seconds.
pub const PERIOD: f64 = 0.1;
const STEP: f64 = 1.0 / 240.0;
const STEPS: usize = 15 * 240;
const STEPS_PER_DECISION: usize = 8;
const STEPS_PER_SAMPLE: usize = 24;

/// The places of the states: air speed, angles of attack and of sideslip, roll, pitch, yaw, their rates, altitude, engine power, and the integrals of
/// the errors of the controller. The benchmark has the position over the ground, too, on which nothing depends.
const SPEED: usize = 0;
const ALPHA: usize = 1;
const BETA: usize = 2;
const PHI: usize = 3;
const THETA: usize = 4;
const PSI: usize = 5;
const P: usize = 6;
const Q: usize = 7;
const R: usize = 8;
const ALTITUDE: usize = 9;
const POWER: usize = 10;
const INTEGRALS: usize = 11;
type State = [f64; 14];

const GRAVITY: f64 = 32.17;
const DEGREES: f64 = 57.29578;
const WING_AREA: f64 = 300.0;
const WING_SPAN: f64 = 30.0;
const CHORD: f64 = 11.32;
/// The reciprocal of the mass.
const PER_MASS: f64 = 1.57e-3;
/// The angular momentum of the engine.
const ENGINE_MOMENTUM: f64 = 160.0;
/// The coefficients of the moment equations, which follow from the moments of inertia.
const C: [f64; 9] = [-0.770, 0.02755, 1.055e-4, 1.642e-6, 0.9604, 1.759e-2, 1.792e-5, -0.7336, 1.587e-5];

/// Runs a test. Records altitude in feet, roll and pitch in radians, and 1 if the pilot flies, 2 if the autopilot rolls, 3 if it pulls.
pub fn run(inputs: &[Input], record: &mut Recorder) {
    let mut state: State = [0.0; 14];
    (state[SPEED], state[ALPHA], state[ALTITUDE], state[POWER]) = (540.0, 2.1215_f64.to_radians(), 2330.0, 9.0);
    for (place, input) in [PHI, THETA, PSI].into_iter().zip(inputs) {
        state[place] = input.at(0, STEPS);
    }
    let mut autopilot = Autopilot { mode: Mode::Roll, pulls_since: 0.0 };
    for step in 0..=STEPS {
        if step > 0 && step % STEPS_PER_DECISION == 0 {
            autopilot.decide(step as f64 * STEP, &state);
        }
        if step % STEPS_PER_SAMPLE == 0 {
            record(&[state[ALTITUDE], state[PHI], state[THETA], f64::from(autopilot.mode as u8)]);
        }
        state = advance(state, STEP, |_, state| slope(&state, autopilot.commands(&state)));
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Mode {
    Standby = 1,
    Roll = 2,
    Pull = 3,
}

/// The ground collision avoidance.
struct Autopilot {
    mode: Mode,
    pulls_since: f64,
}

impl Autopilot {
    fn decide(&mut self, time: f64, state: &State) {
        let path = off_level(state[THETA] - state[ALPHA]);
        let is_level = off_level(state[PHI]).abs() < 5_f64.to_radians() && state[P].abs() < 10_f64.to_radians();
        match self.mode {
            Mode::Standby if path <= 0.0 && state[ALTITUDE] < 1000.0 => self.mode = Mode::Roll,
            Mode::Roll if is_level => (self.mode, self.pulls_since) = (Mode::Pull, time),
            Mode::Pull if path > 0.0 && time >= self.pulls_since + 2.0 => self.mode = Mode::Standby,
            _ => {}
        }
    }

    /// Returns the commanded normal acceleration in g and the commanded roll rate about the velocity.
    fn commands(&self, state: &State) -> [f64; 2] {
        match self.mode {
            Mode::Standby => [0.0, 0.0],
            Mode::Roll => [0.0, -4.0 * off_level(state[PHI]) - 2.0 * state[P]],
            Mode::Pull => [5.0, 0.0],
        }
    }
}

/// Returns an angle without its whole turns.
fn off_level(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round_ties_even()
}

/// Returns the deflections of elevator, aileron and rudder in degrees, which the linear-quadratic regulator demands.
fn deflections(state: &State) -> [f64; 3] {
    const LONGITUDINAL: [f64; 3] = [-156.880_150_672_347_5, -31.037_008_068_526_64, -38.729_833_462_163_17];
    const LATERAL: [[f64; 5]; 2] =
        [[37.84483, -25.40956, -6.82876, -332.88343, -17.15997], [-23.91233, 5.69968, -21.63431, 64.49490, -88.36203]];
    let long = [state[ALPHA] - 0.0389, state[Q], state[INTEGRALS]];
    let lateral = [state[BETA], state[P], state[R], state[INTEGRALS + 1], state[INTEGRALS + 2]];
    let product =
        |gains: &[f64], states: &[f64]| -gains.iter().zip(states).map(|(gain, state)| gain * state).sum::<f64>();
    [
        (product(&LONGITUDINAL, &long) - 0.7496).clamp(-25.0, 25.0),
        product(&LATERAL[0], &lateral).clamp(-21.5, 21.5),
        product(&LATERAL[1], &lateral).clamp(-30.0, 30.0),
    ]
}

/// Returns the slopes of all states under commands of the autopilot.
fn slope(x: &State, [commanded_g, commanded_roll]: [f64; 2]) -> State {
    let surfaces = deflections(x);
    let (sin, cos) = (libm::sin, libm::cos);
    let (speed, phi, theta) = (x[SPEED], x[PHI], x[THETA]);
    let (p, q, r) = (x[P], x[Q], x[R]);
    let (mach, pressure) = air(speed, x[ALTITUDE]);
    let thrust = thrust(x[POWER], x[ALTITUDE], mach);
    let [cx, cy, cz, cl, cm, cn] = coefficients(x, surfaces);

    let [u, v, w] = [speed * cos(x[ALPHA]) * cos(x[BETA]), speed * sin(x[BETA]), speed * sin(x[ALPHA]) * cos(x[BETA])];
    let lift = pressure * WING_AREA;
    let (side, normal) = (PER_MASS * lift * cy, PER_MASS * lift * cz);
    let du = r * v - q * w - GRAVITY * sin(theta) + PER_MASS * (lift * cx + thrust);
    let dv = p * w - r * u + GRAVITY * cos(theta) * sin(phi) + side;
    let dw = q * u - p * v + GRAVITY * cos(theta) * cos(phi) + normal;

    let mut slope: State = [0.0; 14];
    let square = u * u + w * w;
    slope[SPEED] = (u * du + v * dv + w * dw) / speed;
    slope[ALPHA] = (u * dw - w * du) / square;
    slope[BETA] = (speed * dv - v * slope[SPEED]) * cos(x[BETA]) / square;
    let turn = q * sin(phi) + r * cos(phi);
    slope[PHI] = p + sin(theta) / cos(theta) * turn;
    slope[THETA] = q * cos(phi) - r * sin(phi);
    slope[PSI] = turn / cos(theta);
    let roll = lift * WING_SPAN;
    slope[P] = (C[1] * p + C[0] * r + C[3] * ENGINE_MOMENTUM) * q + roll * (C[2] * cl + C[3] * cn);
    slope[Q] = (C[4] * p - C[6] * ENGINE_MOMENTUM) * r + C[5] * (r * r - p * p) + lift * CHORD * C[6] * cm;
    slope[R] = (C[7] * p - C[1] * r + C[8] * ENGINE_MOMENTUM) * q + roll * (C[3] * cl + C[8] * cn);
    slope[ALTITUDE] = u * sin(theta) - v * sin(phi) * cos(theta) - w * cos(phi) * cos(theta);
    slope[POWER] = power_slope(x[POWER], THROTTLE);

    // The pilot sits 15 ft before the centre of gravity.
    let normal_g = -(normal - 15.0 * slope[Q]) / GRAVITY - 1.0;
    let side_g = (side + 15.0 * slope[R]) / GRAVITY;
    // The regulator sees the angle of attack as its distance from the trimmed flight.
    let trimmed = x[ALPHA] - 0.0389;
    slope[INTEGRALS] = normal_g - commanded_g;
    slope[INTEGRALS + 1] = p * cos(trimmed) + r * sin(trimmed) - commanded_roll;
    slope[INTEGRALS + 2] = side_g + r;
    slope
}

/// The throttle of the trimmed flight, which the autopilot leaves as it is.
const THROTTLE: f64 = 0.1395;

/// Returns the Mach number and the dynamic pressure.
fn air(speed: f64, altitude: f64) -> (f64, f64) {
    let factor = 1.0 - 0.703e-5 * altitude;
    let temperature = if altitude >= 35_000.0 { 390.0 } else { 519.0 * factor };
    let density = 2.377e-3 * libm::pow(factor, 4.14);
    (speed / (1.4 * 1716.3 * temperature).sqrt(), 0.5 * density * speed * speed)
}

/// Returns the slope of the engine power in percent per second.
fn power_slope(power: f64, throttle: f64) -> f64 {
    let commanded = if throttle <= 0.77 { 64.94 * throttle } else { 217.38 * throttle - 117.38 };
    let (aim, is_fast) = match (commanded >= 50.0, power >= 50.0) {
        (true, true) => (commanded, true),
        (true, false) => (60.0, false),
        (false, true) => (40.0, true),
        (false, false) => (commanded, false),
    };
    let rate = if is_fast { 5.0 } else { (1.9 - 0.036 * (aim - power)).clamp(0.1, 1.0) };
    rate * (aim - power)
}

const HEIGHTS: [f64; 6] = [0.0, 1e4, 2e4, 3e4, 4e4, 5e4];
const MACHS: [f64; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];
/// The thrust in pounds: a row for each Mach number, a column for each altitude; without power, at military power, and at full power.
const IDLE: [[f64; 6]; 6] = [
    [1060.0, 670.0, 880.0, 1140.0, 1500.0, 1860.0],
    [635.0, 425.0, 690.0, 1010.0, 1330.0, 1700.0],
    [60.0, 25.0, 345.0, 755.0, 1130.0, 1525.0],
    [-1020.0, -170.0, -300.0, 350.0, 910.0, 1360.0],
    [-2700.0, -1900.0, -1300.0, -247.0, 600.0, 1100.0],
    [-3600.0, -1400.0, -595.0, -342.0, -200.0, 700.0],
];
const MILITARY: [[f64; 6]; 6] = [
    [12680.0, 9150.0, 6200.0, 3950.0, 2450.0, 1400.0],
    [12680.0, 9150.0, 6313.0, 4040.0, 2470.0, 1400.0],
    [12610.0, 9312.0, 6610.0, 4290.0, 2600.0, 1560.0],
    [12640.0, 9839.0, 7090.0, 4660.0, 2840.0, 1660.0],
    [12390.0, 10176.0, 7750.0, 5320.0, 3250.0, 1930.0],
    [11680.0, 9848.0, 8050.0, 6100.0, 3800.0, 2310.0],
];
const FULL: [[f64; 6]; 6] = [
    [20000.0, 15000.0, 10800.0, 7000.0, 4000.0, 2500.0],
    [21420.0, 15700.0, 11225.0, 7323.0, 4435.0, 2600.0],
    [22700.0, 16860.0, 12250.0, 8154.0, 5000.0, 2835.0],
    [24240.0, 18910.0, 13760.0, 9285.0, 5700.0, 3215.0],
    [26070.0, 21075.0, 15975.0, 11115.0, 6860.0, 3950.0],
    [28886.0, 23319.0, 18300.0, 13484.0, 8642.0, 5057.0],
];

fn thrust(power: f64, altitude: f64, mach: f64) -> f64 {
    let of = |thrusts: &[[f64; 6]; 6]| {
        table2(&MACHS, &HEIGHTS, |row, column| thrusts[row][column], mach, altitude.max(0.01))
    };
    let military = of(&MILITARY);
    if power < 50.0 {
        let idle = of(&IDLE);
        idle + (military - idle) * power * 0.02
    } else {
        military + (of(&FULL) - military) * (power - 50.0) * 0.02
    }
}

/// Returns the coefficients of the forces along and of the moments about the three axes.
fn coefficients(x: &State, [elevator, aileron, rudder]: [f64; 3]) -> [f64; 6] {
    let [de, da, dr] = [elevator, aileron, rudder].map(f64::to_radians);
    let (a, b) = (x[ALPHA], x[BETA]);
    let per_speed = 0.5 / x[SPEED];
    let [p, q, r] = [x[P] * WING_SPAN * per_speed, x[Q] * CHORD * per_speed, x[R] * WING_SPAN * per_speed];
    let of_alpha = |coefficients: &[f64]| coefficients.iter().rev().fold(0.0, |sum, c| sum * a + c);
    let d = damping(a * DEGREES);

    let cx = of_alpha(&[-1.943367e-2, 2.136104e-1, 6.988016e-1, -9.035381e-1])
        - 2.903457e-1 * de * de
        - 3.348641e-3 * de
        - 2.060504e-1 * a * de
        + q * (of_alpha(&[4.833383e-1, 8.644627, 1.131098e1, -7.422961e1, 6.075776e1]) + d[0]);
    let cy = -1.145916 * b
        + 6.016057e-2 * da
        + 1.642479e-1 * dr
        + p * (of_alpha(&[-1.006733e-1, 8.679799e-1, 4.260586, -6.923267]) + d[2])
        + r * (of_alpha(&[8.071648e-1, 1.189633e-1, 4.177702, -9.162236]) + d[1]);
    let cz = of_alpha(&[-1.378278e-1, -4.211369, 4.775187, -1.026225e1, 8.399763]) * (1.0 - b * b) - 4.354000e-1 * de
        + q * (of_alpha(&[-3.054956e1, -4.132305e1, 3.292788e2, -6.848038e2, 4.080244e2]) + d[3]);
    let cl = b * of_alpha(&[-1.05853e-1, -5.776677e-1, -1.672435e-2, 3.464156, -2.835451])
        + b * b * of_alpha(&[1.357256e-1, 2.172952e-1, -1.098104])
        + p * (of_alpha(&[-4.126806e-1, -1.189974e-1, 1.247721, -7.391132e-1]) + d[5])
        + r * (of_alpha(&[6.250437e-2, 6.067723e-1, -1.101964, 9.100087, -1.192672e1]) + d[4])
        + da * (of_alpha(&[-1.463144e-1, -4.07391e-2, 4.851209e-1, -3.213068e-1])
            + b * of_alpha(&[3.253159e-2, 2.978850e-1, -3.746393e-1]))
        + dr * (2.635729e-2 - 2.192910e-2 * a + b * of_alpha(&[-3.152901e-3, -5.817803e-2, 4.516159e-1, -4.928702e-1])
            - 1.579864e-2 * b * b);
    let cm = -2.029370e-2
        + 4.660702e-2 * a
        + de * of_alpha(&[-6.012308e-1, -8.062977e-2, 5.018538e-1])
        + de * de * (8.320429e-2 + 4.226356e-1 * a + 6.378864e-1 * de)
        + q * (of_alpha(&[-5.19153, -3.554716, -3.598636e1, 2.247355e2, -4.120991e2, 2.411750e2]) + d[6]);
    let cn = b * of_alpha(&[2.993363e-1, 6.594004e-2, -2.107885, 8.476901e-1])
        + b * b * of_alpha(&[-2.003125e-1, -6.233977e-2, 2.141420])
        + p * (of_alpha(&[2.677652e-2, -3.298246e-1, 1.926178e-1, 4.013325, -4.404302]) + d[8])
        + r * (of_alpha(&[-3.698756e-1, -1.167551e-1, -7.641297e-1]) + d[7])
        + da * (of_alpha(&[-3.348717e-2, 4.276655e-2, 2.302543e-1, -2.512876e-1])
            + b * of_alpha(&[6.573646e-3, 3.535831e-1, -1.373308, 1.237582])
            + b * b * b * (1.588105e-1 - 5.199526e-1 * a))
        + dr * (of_alpha(&[-8.115894e-2, -1.156580e-2, 1.004297e-1])
            + b * of_alpha(&[2.514167e-2, 2.038748e-1, -3.337476e-1]));
    [cx, cy, cz, cl, cm, cn]
}

/// Returns the damping terms at an angle of attack in degrees.
fn damping(alpha: f64) -> [f64; 9] {
    const ALPHAS: [f64; 12] = [-10.0, -5.0, 0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0];
    const TERMS: [[f64; 12]; 9] = [
        [-0.267, -0.110, 0.308, 1.34, 2.08, 2.91, 2.76, 2.05, 1.50, 1.49, 1.83, 1.21],
        [0.882, 0.852, 0.876, 0.958, 0.962, 0.974, 0.819, 0.483, 0.590, 1.21, -0.493, -1.04],
        [-0.108, -0.108, -0.188, 0.110, 0.258, 0.226, 0.344, 0.362, 0.611, 0.529, 0.298, -2.27],
        [-8.80, -25.8, -28.9, -31.4, -31.2, -30.7, -27.7, -28.2, -29.0, -29.8, -38.3, -35.3],
        [-0.126, -0.026, 0.063, 0.113, 0.208, 0.230, 0.319, 0.437, 0.680, 0.100, 0.447, -0.330],
        [-0.360, -0.359, -0.443, -0.420, -0.383, -0.375, -0.329, -0.294, -0.230, -0.210, -0.120, -0.100],
        [-7.21, -0.540, -5.23, -5.26, -6.11, -6.64, -5.69, -6.00, -6.20, -6.40, -6.60, -6.00],
        [-0.380, -0.363, -0.378, -0.386, -0.370, -0.453, -0.550, -0.582, -0.595, -0.637, -1.02, -0.840],
        [0.061, 0.052, 0.052, -0.012, -0.013, -0.024, 0.050, 0.150, 0.130, 0.158, 0.240, 0.150],
    ];
    TERMS.map(|terms| table(&ALPHAS, &terms, alpha))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(roll: f64, pitch: f64, yaw: f64) -> Vec<[f64; 4]> {
        let mut rows = Vec::new();
        let inputs = [roll, pitch, yaw].map(|value| Input::new(vec![value]));
        run(&inputs, &mut |row| rows.push(row.try_into().unwrap()));
        rows
    }

    #[test]
    fn it_rolls_level_pulls_up_and_then_leaves_the_aircraft_to_the_pilot() {
        let rows = rows(0.8, -1.0, 0.0);
        assert_eq!(rows.len(), 151);
        let mut modes: Vec<f64> = rows.iter().map(|row| row[3]).collect();
        modes.dedup();
        assert_eq!(modes[..3], [2.0, 3.0, 1.0], "{modes:?}");
        let lowest = rows.iter().map(|row| row[0]).fold(f64::INFINITY, f64::min);
        assert!(rows[0][0] == 2330.0 && lowest < 1500.0 && rows[150][0] > lowest, "{lowest}");
    }

    #[test]
    fn the_altitude_does_not_depend_on_the_yaw_and_a_steeper_dive_goes_lower() {
        let lowest =
            |pitch: f64, yaw: f64| rows(0.8, pitch, yaw).iter().map(|row| row[0]).fold(f64::INFINITY, f64::min);
        assert_eq!(lowest(-1.15, -1.0), lowest(-1.15, -0.5));
        assert!(lowest(-1.25, 0.0) < lowest(-1.15, 0.0));
    }

    #[test]
    fn trimmed_flight_hardly_accelerates() {
        // The trimmed flight of the benchmark's regulator: 502 ft/s at 1,000 ft.
        let mut state: State = [0.0; 14];
        (state[SPEED], state[ALPHA], state[THETA], state[ALTITUDE], state[POWER]) =
            (502.0, 0.0389, 0.0389, 1000.0, 9.0567);
        let slope = slope(&state, [0.0, 0.0]);
        assert!(slope[SPEED].abs() < 1.0 && slope[ALPHA].abs() < 0.02 && slope[Q].abs() < 0.2, "{slope:?}");
        assert!(slope[ALTITUDE].abs() < 1e-9 && slope[P].abs() < 1e-3 && slope[R].abs() < 1e-3, "{slope:?}");
    }
}
