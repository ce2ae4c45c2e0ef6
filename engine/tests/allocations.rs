//! Once a run has begun, its streams allocate nothing.

use paracosm_engine::{
    AutonomousVehicle, Control, Environment, Program, RoadSegment, Run, Scenario, Setup, Step, Stream,
};
use paracosm_engine::{eventually, never};
use paracosm_space::Shape;

/// Every combinator there is.
fn everything(s: &mut Scenario) {
    let friction = s.interval("friction", 0.2..=0.8).signal(Shape::Polynomial { degree: 3 });
    let light = s.interval("light", 0.0..=1.0).signal(Shape::PiecewiseLinear { pieces: 4 });
    let weather = s.choice("weather", ["clear", "fog"]).signal(Shape::PiecewiseConstant { pieces: 5 });
    let road = s.place(RoadSegment::new(200.0).friction(friction));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
    s.place(Environment::new().fog(Stream::constant(0.3)));
    s.duration(5.0);

    let foggy = Stream::from(weather).equals("fog") & !car.speed().above(light);
    let second = Stream::tick().scan(0, |count, ()| count + 1).filter(|count| count % 100 == 0);
    let old = car.position().take(1).concat(&car.position().pre());
    let way = car.position().zip(&old).map(|(new, old)| (new - old).norm()).sum();
    let held = way.when(&second).hold(0.0).merge(&way.min(3.0).max(1.0).abs().sqrt());
    let later = (held.skip_until(&foggy) / 2.0).take_until(&second).merge(&held.pre().initially(-1.0));
    let count = s.forward("count");
    count.define(count.pre().initially(0.0) + 1.0);
    let vectors = (car.position() - old * 0.5).dot(Stream::vector(&later, &*count)).named("vectors");
    s.place(vectors.for_each(|number| assert!(number.is_finite())));
    s.premise(&foggy);
    s.require("vectors", eventually(vectors.at_least(&*count)));
    s.require("clear", never(car.collides() | car.position().x().below(0.0)));
}

#[test]
fn no_tick_allocates() {
    let program = Program::new("everything", "every combinator", everything);
    let test = program.declare().unwrap().nominal();
    let mut run = Run::new(&program, &test, Setup::asking_every(0.05)).unwrap();
    let mut go = |questions: usize| {
        for _ in 0..questions {
            assert!(matches!(run.advance(), Step::Need(_)), "the run ended early");
            assert_eq!(run.weather().fog, 0.3);
            run.supply(Control::default());
        }
    };
    // The first question is asked at the first tick.
    go(1);
    let after = allocation_counter::measure(|| go(99));
    assert_eq!((after.count_total, after.bytes_total), (0, 0));
    let list = allocation_counter::measure(|| drop(std::hint::black_box(vec![0; 4])));
    assert_eq!(list.count_total, 1, "the counter counts");
}
