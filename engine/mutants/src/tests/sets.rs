use crate::{ALL, Condition, Defect, Mutant, find, mutants, mutants_where};
use paracosm_space::{Domain, Parameter, Shape, Space, Value};
use std::collections::BTreeMap;

fn space() -> Space {
    let interval = |name: &str, lo, hi| Parameter::new(name, Domain::Interval { lo, hi });
    let weather = Domain::Choice(vec!["clear".into(), "rain".into(), "fog".into()]);
    let signal = Parameter { signal: Some(Shape::PiecewiseConstant { pieces: 3 }), ..interval("profile", 0.0, 1.0) };
    let parameters = vec![
        interval("speed", 5.0, 20.0),
        signal,
        interval("distance", 5.0, 60.0),
        Parameter::new("weather", weather),
        Parameter::new("country", Domain::Choice(vec!["here".into()])),
        interval("friction", 0.2, 0.8),
    ];
    Space::new(parameters).unwrap()
}

fn is_new(set: &[Mutant]) -> bool {
    set.iter().enumerate().all(|(index, mutant)| !set[..index].contains(mutant))
}

#[test]
fn a_set_is_the_beginning_of_a_larger_set_and_has_no_mutant_twice() {
    let large = mutants(&space(), 1500, 7);
    assert_eq!(large.len(), 1500);
    for count in [0, 1, 10, 55, 700] {
        assert_eq!(mutants(&space(), count, 7), large[..count]);
    }
    assert!(is_new(&large));
    assert_ne!(mutants(&space(), 200, 8), large[..200]);
}

#[test]
fn kinds_take_turns_and_all_sizes_and_numbers_of_conditions_appear() {
    let set = mutants(&space(), 1000, 1);
    for (index, mutant) in set[..ALL.len()].iter().enumerate() {
        assert_eq!(mutant.defect.kind(), ALL[index]);
    }
    let mut sizes: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    let mut conditions = [0; 4];
    for mutant in &set {
        conditions[mutant.when.len()] += 1;
        let sizes = sizes.entry(mutant.defect.kind().name).or_default();
        if !sizes.contains(&mutant.defect.size()) {
            sizes.push(mutant.defect.size());
        }
    }
    assert!(conditions.iter().all(|count| (240..=260).contains(count)), "{conditions:?}");
    assert!(ALL.iter().all(|kind| sizes[kind.name].len() == kind.sizes.len()), "{sizes:?}");
}

#[test]
fn each_size_meets_each_number_of_conditions() {
    for kind in ["short-range", "busy", "slow-self", "late-detection"] {
        let kind = find(kind).unwrap();
        let set = mutants_where(&space(), 4 * kind.sizes.len(), 3, |defect| defect.kind() == kind);
        for &size in kind.sizes {
            for count in 0..4 {
                let is_it = |mutant: &&Mutant| mutant.defect.size() == size && mutant.when.len() == count;
                assert_eq!(set.iter().filter(is_it).count(), 1, "{} {size} with {count}", kind.name);
            }
        }
    }
}

#[test]
fn conditions_are_on_parts_of_constant_parameters_and_never_on_signals() {
    let space = space();
    let mut shares = [0; 3];
    for condition in mutants(&space, 1000, 5).iter().flat_map(|mutant| &mutant.when) {
        match condition {
            Condition::Within { parameter, lo, hi } => {
                let found = space.find(parameter).unwrap();
                assert!(found.check(&Value::from(*lo)).is_ok() && found.check(&Value::from(*hi)).is_ok());
                assert_ne!(parameter, "profile");
                let Domain::Interval { lo: least, hi: most } = found.domain else { panic!("{parameter}") };
                let share = (hi - lo) / (most - least);
                let near = [1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0].iter().position(|whole| (share - whole).abs() < 2e-3);
                shares[near.unwrap_or_else(|| panic!("{condition} covers {share}"))] += 1;
            }
            Condition::Is { parameter, value } => {
                assert_eq!(parameter, "weather");
                assert!(space.find(parameter).unwrap().level(value).is_some());
            }
            Condition::Between { .. } => panic!("{condition}"),
        }
    }
    assert!(shares.iter().all(|count| *count > 300), "{shares:?}");
}

#[test]
fn the_parameters_of_a_mutant_are_in_the_order_of_the_space_and_differ() {
    let space = space();
    let place = |condition: &Condition| space.parameters().iter().position(|p| p.name == condition.parameter());
    let ordered = |mutant: &Mutant| mutant.when.is_sorted_by(|a, b| place(a) < place(b));
    assert!(mutants(&space, 1000, 2).iter().all(ordered));
}

#[test]
fn a_space_with_few_tests_has_few_mutants_and_each_of_them_once() {
    let sizes: usize = ALL.iter().map(|kind| kind.sizes.len()).sum();
    let nothing = Space::new(vec![]).unwrap();
    let set = mutants(&nothing, 100_000, 1);
    assert!(is_new(&set));
    assert_eq!(set.len(), sizes);
    let choice = Parameter::new("side", Domain::Choice(vec!["near".into(), "far".into()]));
    assert_eq!(mutants(&Space::new(vec![choice]).unwrap(), 100_000, 1).len(), 3 * sizes);
    assert!(mutants_where(&space(), 10, 1, |_| false).is_empty());
}

#[test]
fn a_set_can_be_of_some_defects_only() {
    let is_kept = |defect: Defect| defect.kind().name.starts_with("no-brakes") && defect.size() >= 20.0;
    let set = mutants_where(&space(), 300, 1, is_kept);
    assert_eq!(set.len(), 300);
    assert!(is_new(&set) && set.iter().all(|mutant| is_kept(mutant.defect)));
    assert_eq!(mutants_where(&space(), 70, 1, is_kept), set[..70]);
    for kind in ["no-brakes-above", "no-brakes-below", "no-brakes-in-bends"].map(|name| find(name).unwrap()) {
        let turns = set.iter().filter(|mutant| mutant.defect.kind() == kind).count();
        assert_eq!(turns, 100, "{}", kind.name);
    }
}

/// A set must never change, or results that are in the repository cannot be computed again. If a kind is added or a
/// ladder changes, this test changes, and so do the studies.
#[test]
fn the_set_of_a_seed_is_the_same_on_every_machine() {
    let set = mutants(&space(), 400, 1);
    let told: Vec<String> = [0, 3, 55, 133, 399].iter().map(|&index| set[index].to_string()).collect();
    let expected = [
        "short-range 80 m",
        "blind-right 178 deg when speed is 11.32 to 18.82 and distance is 9.39 to 23.14 and friction is 0.3281 to 0.4781",
        "short-range 60 m when distance is 31.93 to 50.27",
        "outages 2.5 s when speed is 13.19 to 18.19",
        "unseen-lorries 10 m when friction is 0.3151 to 0.4651",
    ];
    assert_eq!(told, expected);
}
