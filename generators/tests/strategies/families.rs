//! The rows of each discrete family.

use super::*;

fn family_size(levels: &[usize], delta: f64) -> u64 {
    RandomRows::new(&Rules::free(levels), 2).expect("nothing is entangled").family_size(delta)
}

#[test]
fn a_random_family_covers_all_pairs_at_least_as_often_as_promised() {
    for levels in [vec![2; 8], vec![3, 2, 4, 2, 3]] {
        let space = mixed(0, &levels);
        let delta = 0.2;
        let covers_all_pairs = |seed: u64| {
            let discrete = DiscreteFamily::Random { delta };
            let rows = rows(&Request { seed: Some(seed), discrete, k: Some(2), ..Request::new(&space, 1) });
            // Rows that repeat one are left out: they would be the same test again.
            assert!(rows.len() as u64 <= family_size(&levels, delta));
            assert_eq!(rows.iter().collect::<BTreeSet<_>>().len(), rows.len());
            (0..levels.len()).all(|i| {
                (0..i).all(|j| {
                    let pairs: BTreeSet<_> = rows.iter().map(|row| (row[i], row[j])).collect();
                    pairs.len() == levels[i] * levels[j]
                })
            })
        };
        let seeds = 1000;
        let complete = (0..seeds).filter(|&seed| covers_all_pairs(seed)).count();
        assert!(complete as f64 >= (1.0 - delta) * seeds as f64, "{complete} of {seeds} families are complete");
    }
}

#[test]
fn under_constraints_a_random_family_keeps_them_and_its_promise() {
    let text = "constraints = [\"a == 0 implies b == 0\", \"b == 2 implies c == 1\"]
        parameter = [{ name = \"a\", choice = [0, 1, 2] }, { name = \"b\", choice = [0, 1, 2] },
        { name = \"c\", choice = [0, 1] }, { name = \"d\", choice = [0, 1, 2] }]";
    let space = Space::from_toml(text).expect("a valid space");
    let rules = space.rules().expect("constraints that can be kept");
    let delta = 0.2;
    let is_complete = |seed: u64| {
        let request =
            Request { seed: Some(seed), discrete: DiscreteFamily::Random { delta }, ..Request::new(&space, 1) };
        let rows = rows(&request);
        assert!(rows.iter().all(|row| (row[0] != 0 || row[1] == 0) && (row[1] != 2 || row[2] == 1)));
        let found = kwise_coverage(&rules, 2, rows.iter().map(Vec::as_slice)).expect("rows of the space");
        found.covered == found.valid
    };
    let seeds = 1000;
    let complete = (0..seeds).filter(|&seed| is_complete(seed)).count();
    assert!(complete as f64 >= (1.0 - delta) * seeds as f64, "{complete} of {seeds} families are complete");
}

#[test]
fn the_search_for_epsilon_ends_with_its_time() {
    let space = mixed(1, &[2, 2]);
    let deadline = Deadline::after(std::time::Duration::ZERO);
    let request = Request { epsilon: Some(0.1), deadline, ..Request::new(&space, 500) };
    assert!(tests(Strategy::HALTON, &request).is_empty());
}

#[test]
fn the_random_family_has_as_many_rows_as_the_proposition_asks_for() {
    let (levels, delta) = ([2; 8], 0.2);
    let size = family_size(&levels, delta) as usize;
    let space = mixed(1, &levels);
    let request = Request { discrete: DiscreteFamily::Random { delta }, ..Request::new(&space, 3 * size) };
    let tests = Strategy::HALTON.build(&request).expect("a generator").ask(3 * size);
    // Tests are dealt to the rows in turn.
    assert!((0..2 * size).all(|i| tests[i].discrete == tests[i + size].discrete));
    assert!((1..size).any(|i| tests[0].discrete != tests[i].discrete));
}

#[test]
fn of_fewer_discrete_parameters_than_k_all_combinations_are_covered() {
    let space = mixed(1, &[2, 3]);
    for k in [2, 3] {
        let all = tests(Strategy::HALTON, &Request { k: Some(k), ..Request::new(&space, 6) });
        let rows: BTreeSet<_> = all.into_iter().map(|test| test.discrete).collect();
        assert_eq!(rows.len(), 6, "{k}");
    }
}

#[test]
fn the_cross_family_is_all_combinations_the_first_parameter_slowest() {
    let space = mixed(0, &[2, 3, 2]);
    let rows = rows(&Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 1) });
    assert_eq!(rows.len(), 12);
    assert!(rows.is_sorted());
    assert_eq!(rows.iter().collect::<BTreeSet<_>>().len(), 12);
    assert_eq!((&rows[0][..], &rows[11][..]), (&[0, 0, 0][..], &[1, 2, 1][..]));
}

#[test]
fn a_budget_below_the_number_of_rows_gives_its_first_rows_one_test_each() {
    let space = mixed(2, &[10, 10]);
    let request = Request { discrete: DiscreteFamily::Cross, ..Request::new(&space, 7) };
    for strategy in Strategy::all().filter(|strategy| !strategy.is_adaptive()) {
        let aim = strategy.fills_holes().then_some(Aim::Dispersion);
        let discrete: Vec<_> =
            tests(strategy, &Request { aim, ..request }).into_iter().map(|test| test.discrete).collect();
        assert_eq!(discrete, (0..7).map(|level| vec![0, level]).collect::<Vec<_>>(), "{strategy}");
    }
}
