//! The reference drivers against the published models of UN R157: counts of collisions over the same grids of cases.
//!
//! The Joint Research Centre of the European Commission has published its models as `JRC-FSM` (version 01b05c2). Its
//! counts for each pair of speeds are read from `../shared/reference/jrc_cut_in_counts.csv` beside the repository, or
//! from the folder `$PARACOSM_REFERENCE`; where there is no such file, the tests compare the sums alone, and say so.
//! The page `docs/reference-drivers.md` has the numbers of this test.

mod world;

use paracosm_engine::driver::find;
use paracosm_engine::driver::reference::{Cc, Fsm, Reg157, Rss};
use paracosm_engine::kinematic::BrakingModel;
use std::path::{Path, PathBuf};
use world::{CutIn, CutOut, Following};

/// The cases of a range of speeds.
#[derive(Clone, Copy, PartialEq)]
enum Speeds {
    /// The ego vehicle drives 20 to 60 km/h, and the other 10 km/h or more, both in steps of 10 km/h.
    Low,
    /// The ego vehicle drives 70 to 130 km/h in steps of 20, and the other 10 km/h or more in steps of 30 km/h.
    High,
}

impl Speeds {
    fn name(self) -> &'static str {
        match self {
            Self::Low => "20 to 60 km/h",
            Self::High => "70 to 130 km/h",
        }
    }

    /// Returns the pairs of speeds in km/h of the ego vehicle and of the other.
    fn pairs(self) -> Vec<(u32, u32)> {
        let pairs = |egos: std::ops::RangeInclusive<u32>, step: usize, others: usize| -> Vec<_> {
            egos.step_by(step).flat_map(|ego| (10..ego).step_by(others).map(move |other| (ego, other))).collect()
        };
        match self {
            Self::Low => pairs(20..=60, 10, 10),
            Self::High => pairs(70..=130, 20, 30),
        }
    }
}

/// Counts the collisions of the cut-ins of a pair of speeds in km/h.
type Count = fn((u32, u32)) -> usize;

fn count<M: BrakingModel>(model: &M, (ego, other): (u32, u32), dropping: f64) -> usize {
    CutIn::grid(ego, other).iter().filter(|case| case.collides(model.clone(), dropping)).count()
}

/// `cc` with the conditions of the regulation that the published model leaves out.
fn watchful() -> Cc {
    let mut cc = Cc::default();
    cc.lane_width = 3.5;
    cc.evaluation = 0.4;
    cc
}

/// The published model drops a case if the time to collision is above 2 s at overlap.
const DROPPED: f64 = 2.0;
const NEVER: f64 = f64::INFINITY;

/// A driver as the page names it, the name of the published model, its collisions in the cut-ins at low and at high
/// speeds, and how we count. `agrees` says whether the two have to agree.
struct Compared {
    driver: &'static str,
    published: &'static str,
    collisions: [usize; 2],
    count: Count,
    agrees: [bool; 2],
}

const CC: [usize; 2] = [3728, 3552];

const COMPARED: [Compared; 6] = [
    Compared {
        driver: "`cc`, cases above 2 s dropped",
        published: "CC_human_driver",
        collisions: CC,
        count: |pair| count(&Cc::default(), pair, DROPPED),
        agrees: [true, true],
    },
    Compared {
        driver: "`cc`",
        published: "CC_human_driver",
        collisions: CC,
        count: |pair| count(&Cc::default(), pair, NEVER),
        agrees: [true, false],
    },
    Compared {
        driver: "`cc`, `lane_width` 3.5, `evaluation` 0.4",
        published: "CC_human_driver",
        collisions: CC,
        count: |pair| count(&watchful(), pair, DROPPED),
        agrees: [false, false],
    },
    Compared {
        driver: "`rss`",
        published: "RSS",
        collisions: [880, 1491],
        count: |pair| count(&Rss::default(), pair, NEVER),
        agrees: [true, true],
    },
    Compared {
        driver: "`fsm`",
        published: "FSM",
        collisions: [901, 1649],
        count: |pair| count(&Fsm::default(), pair, NEVER),
        agrees: [true, true],
    },
    Compared {
        driver: "`reg157`",
        published: "Reg157",
        collisions: [2252, 2869],
        count: |pair| count(&Reg157::default(), pair, NEVER),
        agrees: [true, true],
    },
];

const RANGES: [Speeds; 2] = [Speeds::Low, Speeds::High];

fn cases(speeds: Speeds) -> usize {
    speeds.pairs().into_iter().map(|(ego, other)| CutIn::grid(ego, other).len()).sum()
}

/// Returns the file with the published counts, by model and pair of speeds.
fn published() -> Option<String> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/reference");
    let folder = std::env::var_os("PARACOSM_REFERENCE").map_or_else(beside, PathBuf::from);
    let text = std::fs::read_to_string(folder.join("jrc_cut_in_counts.csv")).ok();
    if text.is_none() {
        eprintln!("skipped: the published counts of each pair of speeds are not beside this checkout");
    }
    text
}

/// Returns the published cases and collisions of a model at a pair of speeds in km/h.
fn published_at(text: &str, model: &str, (ego, other): (u32, u32)) -> [usize; 2] {
    let begins = format!(",{model},{ego},{other},");
    let row = text.lines().find_map(|line| line.split_once(&begins)).unwrap_or_else(|| panic!("no row {begins}")).1;
    let mut numbers = row.split(',').map(|number| number.parse().unwrap());
    [numbers.next().unwrap(), numbers.next().unwrap()]
}

/// Returns the page, with single spaces.
fn page() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/reference-drivers.md");
    std::fs::read_to_string(path).unwrap().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Writes a number with commas between thousands.
fn thousands(number: usize) -> String {
    if number < 1000 { number.to_string() } else { format!("{},{:03}", number / 1000, number % 1000) }
}

#[test]
fn the_reference_drivers_collide_in_as_many_cut_ins_as_the_published_models_to_one_percent_and_the_page_says_so() {
    let page = page();
    let mut missing = Vec::new();
    for (at, speeds) in RANGES.into_iter().enumerate() {
        let cases = cases(speeds);
        assert_eq!(cases, [15_930, 14_040][at]);
        for Compared { driver, collisions, count, agrees, .. } in &COMPARED {
            let ours = speeds.pairs().into_iter().map(count).sum::<usize>();
            let difference = ours.abs_diff(collisions[at]) as f64 / cases as f64;
            assert_eq!(difference <= 0.01, agrees[at], "{driver}: {ours}, published {}", collisions[at]);
            let row = format!(
                "| {driver} | {} | {} | {} | {} | {:.2} % |",
                speeds.name(),
                thousands(cases),
                thousands(collisions[at]),
                thousands(ours),
                100.0 * difference
            );
            missing.extend((!page.contains(&row)).then_some(row));
        }
    }
    assert!(missing.is_empty(), "docs/reference-drivers.md lacks the rows\n{}", missing.join("\n"));
}

#[test]
fn the_page_gives_a_source_for_each_setting_of_each_reference_driver_with_its_value() {
    let page = page();
    for name in ["cc", "rss", "fsm", "reg157", "ideal"] {
        for setting in find(name).unwrap().settings {
            let begins = format!("| `{name}` | `{}` | ", setting.name);
            let (_, rest) = page.split_once(&begins).unwrap_or_else(|| panic!("no row {begins}"));
            let value: f64 = rest.split(' ').next().unwrap().parse().unwrap();
            assert!((value - setting.default).abs() < 1e-4, "{begins}: {value}, it is {}", setting.default);
        }
    }
}

#[test]
fn the_counts_of_each_pair_of_speeds_agree_to_one_percent_where_their_sums_do() {
    let Some(text) = published() else { return };
    for (at, speeds) in RANGES.into_iter().enumerate() {
        for Compared { driver, published, collisions, count, agrees } in &COMPARED {
            let mut sum = 0;
            for pair in speeds.pairs() {
                let [cases, theirs] = published_at(&text, published, pair);
                assert_eq!(cases, CutIn::grid(pair.0, pair.1).len());
                sum += theirs;
                let ours = count(pair);
                let near = ours.abs_diff(theirs) as f64 <= 0.01 * cases as f64;
                assert!(near || !agrees[at], "{driver} at {pair:?} km/h: {ours}, published {theirs}");
            }
            assert_eq!(sum, collisions[at], "{driver}");
        }
    }
}

#[test]
fn cc_collides_in_the_published_number_of_cut_outs_and_in_no_following_and_the_page_says_so() {
    let cc = Cc::default();
    let cut_outs: Vec<bool> = CutOut::grid().iter().filter_map(|case| case.collides(cc)).collect();
    let collisions = cut_outs.iter().filter(|collides| **collides).count();
    assert_eq!((cut_outs.len(), collisions), (2352, 59), "the published numbers");
    let followings = Following::grid();
    let following = followings.iter().filter(|case| case.collides(cc)).count();
    assert_eq!((followings.len(), following), (1121, 0), "the published numbers");
    let page = page();
    for row in ["| cut-outs | 2,352 | 59 | 59 |", "| followings | 1,121 | 0 | 0 |"] {
        assert!(page.contains(row), "docs/reference-drivers.md lacks the row\n{row}");
    }
}

#[test]
fn the_horizon_of_cc_changes_no_published_encounter() {
    let mut endless = Cc::default();
    endless.horizon = f64::INFINITY;
    for case in CutOut::grid() {
        assert_eq!(case.collides(Cc::default()).is_some_and(|hit| hit), case.collides(endless).is_some_and(|hit| hit));
    }
    for case in Following::grid() {
        assert_eq!(case.collides(Cc::default()), case.collides(endless));
    }
    for pair in RANGES.into_iter().flat_map(Speeds::pairs) {
        assert_eq!(count(&Cc::default(), pair, NEVER), count(&endless, pair, NEVER), "{pair:?}");
    }
}
