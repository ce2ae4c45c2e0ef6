//! A wheel of the jointed car: its suspension, and the forces of chassis and road on it.
//!
//! The tyre is a stiff damper for the spin of its wheel, so the force along the wheel is implicit in the spin. Across
//! the wheel the force is explicit, and slip is relative to a speed of at least [`Step::slow`], for stability.

use super::super::tyre::Tyre;
use super::{GRAVITY, ROLL_INERTIA, Vehicle, Wheel, apply, vector};
use nalgebra::Vector2;
use rapier3d::dynamics::{MassProperties, RigidBody};
use rapier3d::math::{Pose as Frame, Rotation, Vector};
use rapier3d::prelude::{
    GenericJointBuilder, ImpulseJointHandle, JointAxesMask, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle,
};

/// The compression of a tyre at rest, in metres (CommonRoad, vehicle 2: 158 kN/m under 2.9 kN).
const COMPRESSED: f64 = 0.018;
/// The stiffness of an anti-roll bar divided by that of a spring. It halves the roll of the body to 5 degrees under 1
/// g, so that the car slides before it tips over.
const ROLL_BAR: f64 = 0.5;

/// A wheel and its suspension.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub wheel: RigidBodyHandle,
    joint: ImpulseJointHandle,
    /// The middle of the wheel at rest, as seen from the chassis.
    at: Vector,
    pub front: bool,
    /// The load on the wheel at rest, in newtons, and the part of the load that the spring carries.
    rest: f64,
    sprung: f64,
    /// The stiffness of the spring, in N/m.
    spring: f64,
    /// The damping of the damper, in N s/m.
    damper: f64,
    /// The rotation of the wheel to the left.
    turned: Rotation,
    /// The present load on the wheel, in newtons.
    pub load: f64,
    /// The force of the road across the wheel, in newtons.
    side: f64,
    /// The speeds of the wheel in m/s, along and across.
    speed: Vector2<f64>,
    /// The speed of the wheel's tread in m/s.
    tread: f64,
}

/// The torque on a wheel about its axle, in N m.
#[derive(Debug, Clone, Copy)]
pub(super) enum Torque {
    Engine(f64),
    /// A torque against the wheel's rotation, until the wheel stops.
    Brake(f64),
}

/// The data of a step of the physics, common to all wheels.
pub(super) struct Step<'a> {
    pub vehicle: &'a Vehicle,
    pub chassis: Chassis,
    pub friction: f64,
    pub dt: f64,
    /// The speed in m/s below which slip is no longer relative to the speed.
    slow: f64,
}

/// The position and motion of the chassis.
pub(super) struct Chassis {
    /// The frame of the chassis, whose origin is the car's middle at the height of the axles.
    pub frame: Frame,
    centre: Vector,
    velocity: Vector,
    turning: Vector,
}

impl Corner {
    /// Makes a wheel of a car that goes straight ahead at `speed` m/s. `side` is 1 for the left and -1 for the right.
    pub fn new(
        physics: &mut PhysicsWorld,
        chassis: RigidBodyHandle,
        vehicle: &Vehicle,
        front: bool,
        side: f64,
        speed: f64,
    ) -> Self {
        let radius = vehicle.wheel_radius;
        let along = if front { 0.5 } else { -0.5 } * vehicle.wheelbase;
        let at = vector(along, 0.5 * side * vehicle.track, 0.0);
        let inertia = Vector::splat(vehicle.wheel_inertia as f32);
        let wheel = RigidBodyBuilder::dynamic()
            .translation(at + vector(0.0, 0.0, radius))
            .linvel(vector(speed, 0.0, 0.0))
            .angvel(vector(0.0, speed / radius, 0.0))
            .can_sleep(false)
            .allow_fast_rotation(true)
            .additional_mass_properties(MassProperties::new(Vector::ZERO, vehicle.wheel_mass as f32, inertia));
        let wheel = physics.insert_body(wheel);
        let locked = JointAxesMask::LIN_X | JointAxesMask::LIN_Y | JointAxesMask::ANG_X | JointAxesMask::ANG_Z;
        let joint = physics.insert_impulse_joint(chassis, wheel, GenericJointBuilder::new(locked).local_anchor1(at));
        let rest = 0.5 * vehicle.axle_loads(0.0)[usize::from(!front)];
        let sprung = rest - vehicle.wheel_mass * GRAVITY;
        let omega = std::f64::consts::TAU * vehicle.ride_frequency;
        let spring = sprung / GRAVITY * omega * omega;
        Self {
            wheel,
            joint,
            at,
            front,
            rest,
            sprung,
            spring,
            damper: 2.0 * vehicle.damping_ratio * spring / omega,
            turned: Rotation::IDENTITY,
            load: rest,
            side: 0.0,
            speed: Vector2::new(speed, 0.0),
            tread: speed,
        }
    }

    /// Returns the longest step in seconds at which the wheel's hopping between road and chassis does not diverge. The
    /// limit of an explicit spring `k` and damper `c` under a mass `m` is `k dt² + 2 c dt = 4 m`; this takes `2 m`.
    pub fn longest_step(&self, vehicle: &Vehicle) -> f64 {
        let stiffness = (1.0 + 2.0 * ROLL_BAR) * self.spring + self.rest / COMPRESSED;
        let discriminant = self.damper * self.damper + 2.0 * stiffness * vehicle.wheel_mass;
        (discriminant.sqrt() - self.damper) / stiffness
    }

    /// Returns the distance from the car's middle to the wheel, in metres, positive to the left.
    pub fn left(&self) -> f64 {
        f64::from(self.at.y)
    }

    /// Turns the axle so that the wheel points `angle` radians to the left.
    pub fn turn(&mut self, physics: &mut PhysicsWorld, angle: f64) {
        let (sin, cos) = libm::sincos(0.5 * angle);
        self.turned = Rotation::from_xyzw(0.0, 0.0, sin as f32, cos as f32);
        let joint = physics.impulse_joints.get_mut(self.joint, false).expect("it was inserted");
        joint.data.local_frame1.rotation = self.turned;
    }

    /// Returns the difference of the speeds of the tread and of the road under the wheel, divided by the road's speed.
    pub fn slip(&self, step: &Step) -> f64 {
        (self.tread - self.speed.x).abs() / self.speed.x.abs().max(step.slow)
    }

    /// Returns the greatest force of the road along the wheel for the given force across the wheel, in newtons.
    pub fn grip(&self, step: &Step) -> f64 {
        let limit = step.friction * self.load;
        (limit * limit - self.side * self.side).max(0.0).sqrt()
    }

    /// Returns the height of the wheel above its position at rest, as seen from the chassis, in metres.
    pub fn compression(&self, wheel: &RigidBody, chassis: &Chassis) -> f64 {
        f64::from((wheel.translation() - chassis.frame.translation).dot(chassis.up()))
    }

    /// Sets the force and the torque on the wheel for the next step, and returns the force and the torque on the
    /// chassis. `other` is the compression of the spring on the other side of the car.
    pub fn push(&mut self, step: &Step, wheel: &mut RigidBody, torque: Torque, other: f64) -> (Vector, Vector) {
        let Step { vehicle, chassis, friction, dt, slow } = step;
        let at = wheel.translation();
        let up = chassis.up();
        let compression = self.compression(wheel, chassis);
        let bent = compression + ROLL_BAR * (compression - other);
        let rate = f64::from((wheel.linvel() - chassis.velocity_at(at)).dot(up));
        let spring = up * (self.sprung + self.spring * bent + self.damper * rate) as f32;

        let radius = vehicle.wheel_radius;
        let turned = chassis.frame.rotation * self.turned;
        let axle = turned * Vector::Y;
        let (ahead, left) = level(turned * Vector::X);
        self.load = (self.rest * (1.0 + (radius - f64::from(at.z)) / COMPRESSED)).max(0.0);
        self.speed = Vector2::new(wheel.linvel().dot(ahead), wheel.linvel().dot(left)).map(f64::from);
        let spin = f64::from(wheel.angvel().dot(axle));
        let tyre = Tyre::new(vehicle.cornering_stiffness, *friction, self.load);
        let rolling = self.speed.x.abs().max(*slow);
        let slip = Vector2::new(self.speed.x - radius * spin, self.speed.y) / rolling;
        // The damping of the tyre in N s/m, and the spin after the step if only the road acts.
        let damping = tyre.secant(slip.norm()) / rolling;
        let inertia = vehicle.wheel_inertia / dt;
        let resistance = inertia + radius * radius * damping;
        let free = (inertia * spin + radius * damping * self.speed.x) / resistance;
        let spun = match torque {
            Torque::Engine(torque) => free + torque / resistance,
            Torque::Brake(torque) => free - (torque / resistance).min(free.abs()).copysign(free),
        };
        self.tread = radius * spun;
        let road = tyre.cut(damping * Vector2::new(self.tread - self.speed.x, -self.speed.y));
        self.side = road.y;

        let pushed = ahead * road.x as f32 + left * road.y as f32 + Vector::Z * self.load as f32;
        let turning = axle * (inertia * (spun - spin) + radius * road.x) as f32;
        let lever = vector(0.0, 0.0, -radius);
        apply(wheel, pushed - spring, lever.cross(pushed) + turning);
        (spring, (at - chassis.centre).cross(spring) - turning)
    }

    /// Returns the state of the wheel.
    pub fn report(&self) -> Wheel {
        let faster = self.tread.abs().max(self.speed.x.abs());
        let slip = if faster > 0.0 { (self.tread - self.speed.x) / faster } else { 0.0 };
        Wheel {
            slip_ratio: slip.clamp(-1.0, 1.0),
            slip_angle: libm::atan2(self.speed.y, self.speed.x.abs()),
            load: self.load,
            contact: self.load > 0.0,
        }
    }
}

impl<'a> Step<'a> {
    /// Makes a step of `dt` seconds on a road with this friction coefficient.
    ///
    /// Against a speed across the wheels, a tyre with the stiffness `C` by load is a damper that slows the car at the
    /// rate `C g / v`. An explicit step has to resolve this rate. A side force moves the wheels further if it makes the
    /// car roll or turn than if it only makes the car sway.
    pub fn new(vehicle: &'a Vehicle, chassis: Chassis, friction: f64, dt: f64) -> Self {
        let height = vehicle.centre_of_gravity;
        let rolls =
            1.0 + vehicle.mass * height * (height - vehicle.wheel_radius) / (ROLL_INERTIA * vehicle.yaw_inertia);
        let turns = vehicle.mass * vehicle.front_axle * vehicle.rear_axle() / vehicle.yaw_inertia;
        let slow = vehicle.cornering_stiffness * GRAVITY * dt * rolls.max(turns).max(1.0);
        Self { vehicle, chassis, friction, dt, slow }
    }
}

impl Chassis {
    /// Reads the position and motion of the chassis from a body of the physics.
    pub fn from(body: &RigidBody) -> Self {
        Self { frame: *body.position(), centre: body.center_of_mass(), velocity: body.linvel(), turning: body.angvel() }
    }

    /// Returns the vertical axis of the chassis.
    pub fn up(&self) -> Vector {
        self.frame.rotation * Vector::Z
    }

    /// Returns the velocity of the point of the chassis at a given place.
    pub fn velocity_at(&self, place: Vector) -> Vector {
        self.velocity + self.turning.cross(place - self.centre)
    }
}

/// Returns a direction in the ground plane, and the direction to its left.
fn level(ahead: Vector) -> (Vector, Vector) {
    let ahead = Vector::new(ahead.x, ahead.y, 0.0).normalize();
    (ahead, Vector::new(-ahead.y, ahead.x, 0.0))
}
