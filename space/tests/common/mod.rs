//! A space that several tests speak of.

use paracosm_space::{Domain, Parameter, Space, Value};

/// A drive: one continuous parameter, words, numbers, a mixture of both, and a name that needs brackets.
pub fn drive() -> Space {
    let choice = |name: &str, levels: Vec<Value>| Parameter::new(name, Domain::Choice(levels));
    Space::new(vec![
        choice("weather", vec!["clear".into(), "rain".into(), "fog".into()]),
        Parameter::new("speed", Domain::Interval { lo: 0.0, hi: 10.0 }),
        choice("lanes", vec![2.into(), 4.into(), 6.into()]),
        choice("open", vec![1.into(), 2.into(), 3.into()]),
        choice("gear", vec![1.into(), 2.into(), "auto".into()]),
        choice("many", (0..9).map(Value::from).collect()),
        choice("road surface", vec!["dry".into(), "it's wet".into()]),
    ])
    .unwrap()
}
