//! The model `jointed`: the paper's five bodies, a chassis and four wheels on joints, in a physics engine.
//!
//! A joint lets its wheel turn about the axle and move up and down, and turns the axle of a front wheel about the
//! vertical. All forces except gravity are computed before each step: those of springs and dampers, of engine and
//! brakes, and of the road. The road pushes a wheel up as its tyre is compressed, and along and across as a brush tyre
//! slips ([`corner`]).
//!
//! The contacts of the physics engine are not used. Static friction is a stiff constraint between road and light wheel,
//! which its iterative solver hardly solves (a standing car crept by half a metre in a minute). The point of contact
//! also turns with a fast wheel, and brakes it. The joints alone form a star: one iteration is enough.
//!
//! Brakes and engine know the load on each wheel and ask for no more force than the road gives (an anti-lock system and
//! a traction control). A wheel that slips nevertheless is released.
//!
//! The physics engine computes in 32 bits. Therefore the car stays near the origin of a frame of its own: after some
//! distance it is moved back to the origin.

mod corner;

use super::{Drive, Dynamics, GRAVITY, Pedals, Resistance, Vehicle, VehicleState, Wheel};
use corner::{Chassis, Corner, Step, Torque};
use nalgebra::Vector2;
use paracosm_road::Pose;
use paracosm_road::wrapped;
use rapier3d::dynamics::{MassProperties, RigidBody};
use rapier3d::math::Vector;
use rapier3d::prelude::{PhysicsWorld, RigidBodyBuilder, RigidBodyHandle};

/// The share of the friction that brakes and engine use. The rest keeps a wheel from running away.
const USED: f64 = 0.995;
/// The slip at which a wheel is released.
const LET_GO: f64 = 0.3;
/// The moments of inertia of the body about its long and its cross axis, divided by that about the vertical
/// (CommonRoad, vehicle 2: 207 and 1566 by 1792 kg m²).
const ROLL_INERTIA: f64 = 0.116;
const PITCH_INERTIA: f64 = 0.874;
/// The z component of the chassis's vertical axis below which the car counts as tipped over.
const UPRIGHT: f32 = 0.5;
/// The speeds in m/s and rad/s below which a braking car stands. The remaining motion is that of the body on locked
/// wheels, which moves the frame and not the car.
const STANDS: f64 = 0.01;
/// The distance in metres from the origin at which the car is moved back to it.
const FAR: f32 = 32.0;

/// A model of a car as a chassis and four wheels on joints, in a physics engine.
///
/// It can tip over: in a bend, if the friction exceeds half of the track divided by the height of the centre of
/// gravity; in the worst spins at two thirds of that, if the road pushes it to both sides in turn and the body rolls
/// further than in equilibrium. The body has no contacts, so the model ends there: its state becomes NaN.
pub struct Jointed {
    vehicle: Vehicle,
    state: VehicleState,
    physics: PhysicsWorld,
    chassis: RigidBodyHandle,
    corners: [Corner; 4],
    /// The longest step of the physics, in seconds.
    piece: f64,
    /// The pose in the world of the frame of the physics.
    origin: Pose,
    /// The velocity of the car's middle in the frame of the physics, in m/s.
    drift: Vector2<f64>,
    resistance: Resistance,
}

impl Jointed {
    /// Makes a car whose middle has the pose `start` and that goes straight ahead at `speed` m/s.
    ///
    /// # Panics
    /// The vehicle has a [`Vehicle::flaw`].
    pub fn new(vehicle: &Vehicle, start: Pose, speed: f64) -> Self {
        let vehicle = &vehicle.checked();
        let mut physics = PhysicsWorld { gravity: vector(0.0, 0.0, -GRAVITY), ..PhysicsWorld::default() };
        let parameters = &mut physics.integration_parameters;
        parameters.num_solver_iterations = 1;
        parameters.num_internal_stabilization_iterations = 0;
        parameters.max_ccd_substeps = 0;
        let chassis = RigidBodyBuilder::dynamic()
            .translation(vector(0.0, 0.0, vehicle.wheel_radius))
            .linvel(vector(speed, 0.0, 0.0))
            .can_sleep(false)
            .additional_mass_properties(chassis_mass(vehicle));
        let chassis = physics.insert_body(chassis);
        let corners = [(true, 1.0), (true, -1.0), (false, 1.0), (false, -1.0)]
            .map(|(front, side)| Corner::new(&mut physics, chassis, vehicle, front, side, speed));
        // The bodies know their centres of mass only after the engine has seen them.
        physics.integration_parameters.dt = 0.0;
        physics.step();
        let piece = corners.iter().map(|corner| corner.longest_step(vehicle)).fold(f64::INFINITY, f64::min);
        let state = VehicleState::new(start, speed);
        Self {
            vehicle: *vehicle,
            state,
            physics,
            chassis,
            corners,
            piece,
            origin: start,
            drift: Vector2::new(speed, 0.0),
            resistance: Resistance::default(),
        }
    }

    /// Returns the same car with resistances against its motion.
    pub fn against(self, resistance: Resistance) -> Self {
        Self { resistance, ..self }
    }

    /// Turns the front wheels, each so that both roll about the same point on the line of the rear axle (Ackermann).
    fn steer(&mut self, steering: f64, dt: f64) {
        let before = self.state.steering_angle;
        self.state.steer(&self.vehicle, steering, dt);
        if self.state.steering_angle == before {
            return;
        }
        let (sin, cos) = libm::sincos(self.state.steering_angle);
        let length = self.vehicle.wheelbase;
        for corner in self.corners.iter_mut().filter(|corner| corner.front) {
            corner.turn(&mut self.physics, libm::atan2(length * sin, length * cos - corner.left() * sin));
        }
    }

    /// Sets forces and torques on the bodies for the next step.
    fn push(&mut self, throttle: f64, friction: f64, dt: f64) {
        let chassis = Chassis::from(&self.physics.bodies[self.chassis]);
        let step = Step::new(&self.vehicle, chassis, friction, dt);
        let torques = self.torques(&step, throttle);
        let bodies = &mut self.physics.bodies;
        let compressions = self.corners.map(|corner| corner.compression(&bodies[corner.wheel], &step.chassis));
        let (mut force, mut torque) = (Vector::ZERO, Vector::ZERO);
        for (i, corner) in self.corners.iter_mut().enumerate() {
            // The wheels on the left and on the right of an axle follow each other.
            let (push, turn) = corner.push(&step, &mut bodies[corner.wheel], torques[i], compressions[i ^ 1]);
            force += push;
            torque += turn;
        }
        let slowed = self.slowed(dt);
        apply(&mut self.physics.bodies[self.chassis], force + slowed, torque);
    }

    /// Returns the force of the resistances on the chassis, at most the force that stops the car within `dt` seconds.
    fn slowed(&self, dt: f64) -> Vector {
        let speed = self.drift.norm();
        if self.resistance.is_none() || speed == 0.0 {
            return Vector::ZERO;
        }
        let deceleration = self.resistance.deceleration(&self.vehicle, speed).min(speed / dt);
        let force = -self.vehicle.mass * deceleration / speed * self.drift;
        vector(force.x, force.y, 0.0)
    }

    /// Returns the torques of engine or brakes on the wheels.
    ///
    /// Each wheel that they act on gets a share in proportion to its load. Its torque accelerates the wheel itself and,
    /// through the road, the rest of the car with the other wheels.
    fn torques(&self, step: &Step, throttle: f64) -> [Torque; 4] {
        let vehicle = step.vehicle;
        let radius = vehicle.wheel_radius;
        let brakes = throttle < 0.0;
        let demand = vehicle.demand(throttle, self.state.velocity.x.max(0.0)).abs();
        let acts = |corner: &Corner| match vehicle.drive {
            _ if brakes => true,
            Drive::Front => corner.front,
            Drive::Rear => !corner.front,
            Drive::Four => true,
        };
        let total: f64 = self.corners.iter().filter(|corner| acts(corner)).map(|corner| corner.load).sum();
        let idle = self.corners.iter().filter(|corner| !acts(corner)).count();
        let spin = vehicle.wheel_inertia / (radius * radius);
        let mass = vehicle.mass + idle as f64 * spin;
        self.corners.map(|corner| {
            let torque = if acts(&corner) && corner.load > 0.0 && corner.slip(step) < LET_GO {
                let moved = mass * corner.load / total;
                let acceleration = demand.min(USED * corner.grip(step) / moved);
                radius * acceleration * (moved + spin)
            } else {
                0.0
            };
            if brakes { Torque::Brake(torque) } else { Torque::Engine(torque) }
        })
    }

    /// Reads the present motion of the car.
    fn read(&mut self, throttle: f64, dt: f64) {
        let body = &self.physics.bodies[self.chassis];
        let chassis = Chassis::from(body);
        if chassis.up().z < UPRIGHT {
            self.state.lose();
            return;
        }
        let forward = chassis.frame.rotation * Vector::X;
        let heading = libm::atan2(f64::from(forward.y), f64::from(forward.x));
        let middle = Pose { position: flat(chassis.frame.translation), heading };
        let drift = flat(chassis.velocity_at(chassis.frame.translation));
        let mut velocity = Pose { position: Vector2::zeros(), heading }.to_local(drift);
        let mut yaw_rate = f64::from(body.angvel().z);
        if throttle < 0.0 && velocity.norm() < STANDS && yaw_rate.abs() < STANDS {
            (velocity, yaw_rate) = (Vector2::zeros(), 0.0);
            self.origin = self.state.pose().then(&origin_from(&middle));
        } else {
            // The engine has moved the bodies with their velocities after the step.
            self.origin = self.origin.then(&Pose { position: 0.5 * dt * (self.drift - drift), heading: 0.0 });
        }
        self.drift = drift;
        let now = self.origin.then(&middle);
        let ahead = self.vehicle.ahead();
        let state = &mut self.state;
        let at_centre = |velocity: Vector2<f64>, yaw_rate: f64| velocity + Vector2::new(0.0, ahead * yaw_rate);
        let (before, after) = (at_centre(state.velocity, state.yaw_rate), at_centre(velocity, yaw_rate));
        let mean = 0.5 * (before + after);
        let turn = 0.5 * (state.yaw_rate + yaw_rate);
        state.acceleration = (after - before) / dt + turn * Vector2::new(-mean.y, mean.x);
        state.travelled += 0.5 * (state.velocity.norm() + velocity.norm()) * dt;
        state.heading += wrapped(now.heading - state.heading);
        (state.position, state.velocity, state.yaw_rate) = (now.position, velocity, yaw_rate);
    }

    /// Moves the car back to the origin of the frame of the physics.
    fn bring_back(&mut self) {
        let at = self.physics.bodies[self.chassis].translation();
        if at.x.abs().max(at.y.abs()) < FAR {
            return;
        }
        let away = Vector::new(at.x, at.y, 0.0);
        self.origin = self.origin.then(&Pose { position: flat(away), heading: 0.0 });
        for body in self.corners.iter().map(|corner| corner.wheel).chain([self.chassis]) {
            let body = &mut self.physics.bodies[body];
            body.set_translation(body.translation() - away, false);
        }
    }
}

impl Dynamics for Jointed {
    fn step(&mut self, pedals: Pedals, friction: f64, dt: f64) {
        if !self.state.accepts(pedals, friction, dt) {
            return;
        }
        let Pedals { throttle, steering } = pedals.clamped();
        let pieces = (dt / self.piece).ceil();
        let dt = dt / pieces;
        for _ in 0..pieces as usize {
            if !self.state.is_finite() {
                return;
            }
            self.steer(steering, dt);
            self.push(throttle, friction, dt);
            self.physics.integration_parameters.dt = dt as f32;
            self.physics.step();
            self.read(throttle, dt);
            self.bring_back();
        }
    }

    fn state(&self) -> &VehicleState {
        &self.state
    }

    fn wheels(&self) -> [Wheel; 4] {
        self.corners.map(|corner| corner.report())
    }
}

/// Returns the mass and inertia of the car without its wheels, as seen from its middle at the height of its axles.
fn chassis_mass(vehicle: &Vehicle) -> MassProperties {
    let wheels = 4.0 * vehicle.wheel_mass;
    let mass = vehicle.mass - wheels;
    let ahead = vehicle.mass * vehicle.ahead() / mass;
    let above = vehicle.mass * (vehicle.centre_of_gravity - vehicle.wheel_radius) / mass;
    let inertia = vehicle.yaw_inertia * Vector2::new(ROLL_INERTIA, PITCH_INERTIA);
    MassProperties::new(vector(ahead, 0.0, above), mass as f32, vector(inertia.x, inertia.y, vehicle.body_inertia()))
}

/// Sets force and torque at the centre of mass of a body for the next step.
fn apply(body: &mut RigidBody, force: Vector, torque: Vector) {
    body.reset_forces(false);
    body.reset_torques(false);
    body.add_force(force, false);
    body.add_torque(torque, false);
}

/// Returns the origin of a frame as seen from an object that has the pose `local` in the frame.
fn origin_from(local: &Pose) -> Pose {
    Pose { position: local.to_local(Vector2::zeros()), heading: -local.heading }
}

fn vector(x: f64, y: f64, z: f64) -> Vector {
    [x, y, z].map(|x| x as f32).into()
}

fn flat(vector: Vector) -> Vector2<f64> {
    Vector2::new(f64::from(vector.x), f64::from(vector.y))
}
