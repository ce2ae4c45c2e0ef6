//! The model `single-track`: a single wheel stands for the two wheels of an axle, and the car does not pitch or roll.
//!
//! The state is the velocity of the centre of gravity ahead (`u`) and to the left (`v`) and the yaw rate (`r`) in
//! Newton's and Euler's equations in the plane (Rajamani, "Vehicle Dynamics and Control", 2012, chapter 2). The forces
//! are the longitudinal forces that the [`Vehicle`] allows and the side forces of a brush tyre, limited to the friction
//! circle of the axle's load.
//!
//! Straight ahead, none of this is needed and the motion is exact ([`Motion`]). In a bend, a step consists of pieces of
//! at most [`PIECE`] seconds. Each is a linearly implicit Euler step: the slip angle is a speed across divided by a
//! speed along, so that the tyres become stiffer without bound as the car slows down, and an explicit step would
//! diverge. At low speed, the implicit step becomes the kinematic model, in which the axles move where they point.
//! Below [`SLOW`] the side force of a tyre is viscous, and a sliding car comes to rest.

use super::tyre::Tyre;
use super::{Drive, Dynamics, Motion, Pedals, Resistance, Vehicle, VehicleState, Wheel};
use nalgebra::{Matrix3, Vector2, Vector3};
use paracosm_road::Pose;

/// The longest piece of a step in a bend, in seconds.
const PIECE: f64 = 0.002;
/// The speed in m/s below which slip is no longer relative to the speed.
const SLOW: f64 = 0.1;
/// The speeds in m/s and rad/s below which a braking car stands, and a car that has stopped turning goes straight.
const STILL: f64 = 1e-9;

/// A model of a car in which one wheel stands for the two wheels of an axle (dynamic bicycle model).
#[derive(Debug, Clone)]
pub struct SingleTrack {
    vehicle: Vehicle,
    state: VehicleState,
    /// The last inputs: the throttle, and the friction of the road.
    throttle: f64,
    friction: f64,
    resistance: Resistance,
    straight: Straight,
}

/// The straight line that the car moves on.
#[derive(Debug, Clone, Copy)]
struct Straight {
    from: Vector2<f64>,
    along: Vector2<f64>,
    /// The distance that the car had travelled at the start of the line.
    travelled: f64,
}

/// An axle on the road, as one wheel that has the loads and forces of two.
#[derive(Debug, Clone, Copy)]
struct Axle {
    load: f64,
    tyre: Tyre,
    /// The rates at which the axle's speeds along and across grow with `u`, `v`, `r`. Its forces act on them likewise.
    forward: Vector3<f64>,
    left: Vector3<f64>,
    /// The speeds of the axle in m/s along and across.
    speed: Vector2<f64>,
    /// The forces of the axle in newtons along and across.
    force: Vector2<f64>,
    /// The rate at which the force across falls as the speed across grows, in N s/m.
    damping: f64,
}

impl SingleTrack {
    /// Makes a car whose middle has the pose `start` and that goes straight ahead at `speed` m/s.
    ///
    /// # Panics
    /// The vehicle has a [`Vehicle::flaw`].
    pub fn new(vehicle: &Vehicle, start: Pose, speed: f64) -> Self {
        let state = VehicleState::new(start, speed);
        let (straight, resistance) = (Straight::from(&state), Resistance::default());
        Self { vehicle: vehicle.checked(), straight, state, throttle: 0.0, friction: 0.0, resistance }
    }

    /// Returns the same car with resistances against its motion.
    pub fn against(self, resistance: Resistance) -> Self {
        Self { resistance, ..self }
    }

    /// Returns `true` if the car goes straight ahead and will continue to do so.
    fn is_straight(&self, steering: f64) -> bool {
        let state = &self.state;
        steering == 0.0
            && state.steering_angle == 0.0
            && state.velocity.y == 0.0
            && state.yaw_rate == 0.0
            && state.velocity.x >= 0.0
    }

    fn go_straight(&mut self, dt: f64) {
        let speed = self.state.velocity.x;
        let demand = self.vehicle.acceleration(self.throttle, speed, self.friction) - self.slowed(speed);
        let state = &mut self.state;
        let before = Motion { speed, acceleration: state.acceleration.x, travelled: state.travelled };
        let motion = before.after(demand, dt);
        state.velocity.x = motion.speed;
        state.acceleration = Vector2::new(motion.acceleration, 0.0);
        state.travelled = motion.travelled;
        state.position = self.straight.from + self.straight.along * (motion.travelled - self.straight.travelled);
    }

    /// Returns the deceleration in m/s² by the resistances. They never move a car that stands.
    fn slowed(&self, speed: f64) -> f64 {
        if speed > 0.0 { self.resistance.deceleration(&self.vehicle, speed) } else { 0.0 }
    }

    fn turn(&mut self, dt: f64) {
        let pieces = (dt / PIECE).ceil();
        let piece = dt / pieces;
        let ahead = self.vehicle.ahead();
        let before = self.motion();
        let mut centre = self.state.position + self.state.pose().forward() * ahead;
        let mut motion = before;
        for _ in 0..pieces as usize {
            let change = self.change(&motion, piece);
            let mean = motion + 0.5 * change;
            self.state.acceleration.x = change.x / piece - mean.y * mean.z;
            motion += change;
            let middle = Vector2::new(mean.x, mean.y - ahead * mean.z);
            let (sin, cos) = libm::sincos(self.state.heading + 0.5 * piece * mean.z);
            centre += piece * Vector2::new(cos * mean.x - sin * mean.y, sin * mean.x + cos * mean.y);
            self.state.heading += piece * mean.z;
            self.state.travelled += piece * middle.norm();
        }
        let turned = |motion: &Vector3<f64>| Vector2::new(-motion.y, motion.x) * motion.z;
        self.state.acceleration = (motion - before).xy() / dt + 0.5 * (turned(&before) + turned(&motion));
        if self.throttle < 0.0 && motion.amax() < STILL {
            motion = Vector3::zeros();
        } else if self.state.steering_angle == 0.0 && motion.yz().amax() < STILL {
            motion = Vector3::new(motion.x, 0.0, 0.0);
        }
        self.state.velocity = Vector2::new(motion.x, motion.y - ahead * motion.z);
        self.state.yaw_rate = motion.z;
        self.state.position = centre - self.state.pose().forward() * ahead;
        self.straight = Straight::from(&self.state);
    }

    /// Returns the velocity of the centre of gravity ahead and to the left, and the yaw rate.
    fn motion(&self) -> Vector3<f64> {
        let VehicleState { velocity, yaw_rate, .. } = self.state;
        Vector3::new(velocity.x, velocity.y + self.vehicle.ahead() * yaw_rate, yaw_rate)
    }

    /// Returns the change of a motion in `dt` seconds.
    fn change(&self, motion: &Vector3<f64>, dt: f64) -> Vector3<f64> {
        let mass = self.vehicle.mass;
        let (u, v, r) = (motion.x, motion.y, motion.z);
        // The frame turns with the car. These are Newton's law in this frame and its derivatives.
        let mut force = mass * Vector3::new(v * r, -u * r, 0.0);
        let mut stiffness = mass * Matrix3::new(0.0, -r, -v, r, 0.0, u, 0.0, 0.0, 0.0);
        for axle in self.axles(motion, dt) {
            force += axle.force.x * axle.forward + axle.force.y * axle.left;
            stiffness += axle.damping * axle.left * axle.left.transpose();
        }
        let slowed = self.slowed(u.abs()).min(u.abs() / dt);
        force.x -= mass * slowed.copysign(u);
        let inertia = Matrix3::from_diagonal(&Vector3::new(mass, mass, self.vehicle.yaw_inertia));
        let inverse = (inertia + dt * stiffness).try_inverse();
        inverse.map_or(Vector3::repeat(f64::NAN), |inverse| inverse * force * dt)
    }

    /// Returns the axles of a car in this motion. The brakes' force is at most what stops the car within `dt` seconds.
    fn axles(&self, motion: &Vector3<f64>, dt: f64) -> [Axle; 2] {
        let vehicle = &self.vehicle;
        let demand = vehicle.acceleration(self.throttle, motion.x.max(0.0), self.friction);
        let loads = vehicle.axle_loads(self.state.acceleration.x);
        let brakes = self.throttle < 0.0;
        let pull = if brakes { demand.max(-motion.x.abs() / dt).copysign(-motion.x) } else { demand };
        let share = loads[0] / (loads[0] + loads[1]);
        let share = match vehicle.drive {
            Drive::Front if !brakes => 1.0,
            Drive::Rear if !brakes => 0.0,
            _ => share,
        };
        let total = vehicle.mass * pull;
        let axle = |load: f64, share: f64, angle: f64, arm: f64| {
            let tyre = Tyre::new(vehicle.cornering_stiffness, self.friction, load);
            let (sin, cos) = libm::sincos(angle);
            let (forward, left) = (Vector3::new(cos, sin, arm * sin), Vector3::new(-sin, cos, arm * cos));
            let speed = Vector2::new(forward.dot(motion), left.dot(motion));
            let rolling = speed.x.abs().max(SLOW);
            let (side, slope) = tyre.side_force(speed.y / rolling);
            let force = tyre.cut(Vector2::new(share * total, -side));
            Axle { load, tyre, forward, left, speed, force, damping: slope / rolling }
        };
        [
            axle(loads[0], share, self.state.steering_angle, vehicle.front_axle),
            axle(loads[1], 1.0 - share, 0.0, -vehicle.rear_axle()),
        ]
    }
}

impl Dynamics for SingleTrack {
    fn step(&mut self, pedals: Pedals, friction: f64, dt: f64) {
        if !self.state.accepts(pedals, friction, dt) {
            return;
        }
        let Pedals { throttle, steering } = pedals.clamped();
        (self.throttle, self.friction) = (throttle, friction);
        if self.is_straight(steering) {
            self.go_straight(dt);
        } else {
            self.state.steer(&self.vehicle, steering, dt);
            self.turn(dt);
        }
    }

    fn state(&self) -> &VehicleState {
        &self.state
    }

    /// Returns the wheels. Both wheels of an axle are equal, each with half of its load.
    fn wheels(&self) -> [Wheel; 4] {
        let [front, rear] = self.axles(&self.motion(), PIECE).map(|axle| axle.wheel());
        [front, front, rear, rear]
    }
}

impl Straight {
    /// Returns the line that begins at the present position of the car.
    fn from(state: &VehicleState) -> Self {
        Self { from: state.position, along: state.pose().forward(), travelled: state.travelled }
    }
}

impl Axle {
    fn wheel(&self) -> Wheel {
        Wheel {
            slip_ratio: self.tyre.slip_ratio(self.force),
            slip_angle: libm::atan2(self.speed.y, self.speed.x.abs()),
            load: 0.5 * self.load,
            contact: self.load > 0.0,
        }
    }
}
