//! What is refused, in words that help.

use super::*;

#[test]
fn what_cannot_be_built_is_refused_with_the_numbers() {
    let (empty, cube, rows) = (Space::unit_cube(0), Space::unit_cube(2), mixed(1, &[2, 3]));
    let huge = mixed(1, &[11; 7]);
    let beyond = mixed(1, &[1000; 7]);
    let random = |delta| DiscreteFamily::Random { delta };
    let check = |strategy, request: Request, message: &str| {
        assert_eq!(refusal(strategy, &request).to_string(), message);
    };
    check(Strategy::HALTON, Request::new(&empty, 5), "the space has no parameters; a generator needs at least one");
    check(Strategy::HALTON, Request::new(&cube, 0), "the budget is 0 tests; a budget must be at least 1");
    let sequences = "halton, halton-scrambled, sobol, sobol-owen, kronecker";
    for strategy in [Strategy::RANDOM, Strategy::LHS, Strategy::FIBONACCI, Strategy::HAMMERSLEY] {
        let message =
            format!("`{strategy}` is not a sequence and cannot skip points; use one of {sequences}, or do not skip");
        check(strategy, Request { skip: Some(3), ..Request::new(&cube, 5) }, &message);
    }
    let none = "k is 0, expected a number from 1 to the number of discrete parameters, which is 2";
    check(Strategy::HALTON, Request { k: Some(0), ..Request::new(&rows, 5) }, none);
    let all = "k is 4, but the space has 3 parameters; expected k from 1 to that number";
    check(Strategy::HALTON, Request { k: Some(4), ..Request::new(&rows, 5) }, all);
    for delta in [0.0, 1.0, f64::NAN, -0.5] {
        let message = format!("delta is {delta}; the probability of missing a combination must be above 0 and below 1");
        check(Strategy::HALTON, Request { discrete: random(delta), ..Request::new(&rows, 5) }, &message);
    }
    check(
        Strategy::HALTON,
        Request { discrete: DiscreteFamily::Cross, ..Request::new(&huge, 5) },
        "the discrete family has 19487171 rows, more than 10,000,000; use the family ipog",
    );
    check(
        Strategy::HALTON,
        Request { discrete: DiscreteFamily::Cross, ..Request::new(&beyond, 5) },
        "the discrete family has over 10^19 rows, more than 10,000,000; use the family ipog",
    );
    let refused = refusal(Strategy::HALTON, &Request { k: Some(7), discrete: random(0.05), ..Request::new(&huge, 5) });
    assert!(refused.to_string().ends_with("more than 10,000,000; use a smaller k, or the family ipog"), "{refused}");
    check(
        Strategy::HALTON,
        Request { k: Some(7), ..Request::new(&huge, 5) },
        "the covering array needs at least 19487171 tests, more than 10000000; lower the strength",
    );
    check(
        Strategy::LHS,
        Request::new(&cube, usize::MAX),
        "`lhs` makes its points as a whole, and 18446744073709551615 points in 2 dimensions have more than 10,000,000 \
         coordinates, the most that are kept in memory; use halton",
    );
    check(
        Strategy::LATTICE,
        Request::new(&cube, 5_000_001),
        "`lattice` makes its points as a whole, and 5000001 points in 2 dimensions have more than 10,000,000 coordinates, \
         the most that are kept in memory; use halton",
    );
    check(
        Strategy::HALTON,
        Request { skip: Some(1 << 53), ..Request::new(&cube, 5) },
        "`halton` has 9007199254740992 points, but the request needs index 9007199254740996; lower the budget or the skip",
    );
    for strategy in [Strategy::SOBOL, Strategy::KRONECKER] {
        let message = format!(
            "`{strategy}` has 9007199254740992 points, but the request needs index 18446744073709551614; lower the \
             budget or the skip"
        );
        check(strategy, Request { skip: Some(u64::MAX), ..Request::new(&cube, 5) }, &message);
    }
    check(
        Strategy::HAMMERSLEY,
        Request::new(&cube, usize::MAX),
        "`hammersley` has 9007199254740992 points, but the request needs index 18446744073709551614; lower the budget or \
         the skip",
    );
    let cubes = [1, 3, 1001, 21_202].map(Space::unit_cube);
    check(
        Strategy::FIBONACCI,
        Request::new(&cubes[1], 5),
        "`fibonacci` is made for exactly 2 continuous coordinates; the space has 3; use kronecker",
    );
    assert!(Strategy::FIBONACCI.build(&Request::new(&cubes[0], 5)).is_err());
    check(
        Strategy::HALTON_SCRAMBLED,
        Request::new(&cubes[2], 5),
        "`halton-scrambled` is made for at most 1000 continuous coordinates; the space has 1001; use sobol-owen",
    );
    check(
        Strategy::SOBOL,
        Request::new(&cubes[3], 5),
        "`sobol` is made for at most 21201 continuous coordinates; the space has 21202; use halton",
    );
}

#[test]
fn names_are_read_back_and_unknown_ones_meet_a_suggestion() {
    for strategy in Strategy::all() {
        assert_eq!(strategy.name().parse(), Ok(strategy));
        assert_eq!(strategy.to_string(), strategy.name());
        assert!(!strategy.about().contains('\n'));
    }
    assert_eq!("cross".parse(), Ok(DiscreteFamily::Cross));
    assert_eq!("random".parse(), Ok(DiscreteFamily::Random { delta: 0.05 }));
    assert_eq!("ipog".parse(), Ok(DiscreteFamily::default()));
    let error = |name: &str| name.parse::<Strategy>().expect_err("an unknown name").to_string();
    assert_eq!(error("haltom"), "no strategy is called `haltom` (did you mean `halton`?)");
    assert_eq!(error("zzz"), "no strategy is called `zzz`");
    let family = "crss".parse::<DiscreteFamily>().expect_err("an unknown name").to_string();
    assert_eq!(
        family,
        "no discrete family is called `crss` (did you mean `cross`?); the families are ipog, random and cross"
    );
}
