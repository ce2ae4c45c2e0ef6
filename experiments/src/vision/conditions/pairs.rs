//! Every pair of light, fog, rain, sun, lens, traffic and colour, and the values that are guilty of misses.

use super::world::{COLOURS, TRAFFIC};
use super::{FOCAL_MM, Failure, Findings, Named, RATE, columns, fields, numbers, study, words};
use paracosm::analysis::{Conclusion, LocatedReport};
use paracosm::{Campaign, Sampling, Trial};

/// The most further tests that search for guilty values.
const FURTHER: usize = 100;

/// Runs a covering array of all pairs, and searches for the guilty values.
pub fn of(detector: &Named, threshold: f64) -> Result<Findings, Failure> {
    let open = [
        ("light", numbers(&[1.0, 0.5, 0.2])),
        ("fog", numbers(&[0.0, 0.1, 0.2])),
        ("rain", numbers(&[0.0, 0.5, 1.0])),
        ("sun_elevation", numbers(&[50.0, 20.0, 5.0])),
        ("traffic", numbers(&TRAFFIC)),
        ("colour", words(&COLOURS)),
    ];
    let study = study(detector, threshold, &open, numbers(&[FOCAL_MM, 24.0, 50.0]), RATE)?;
    let study = study.sampling(Sampling { k: Some(2), seed: Some(1), ..Sampling::default() }).build()?;
    let log = Campaign::new(&study)?.into_log()?;
    let campaign = Campaign::new(&study)?;
    let mut index = log.trials().len();
    let located = LocatedReport::of(&log, FURTHER, |test| {
        index += 1;
        Ok(campaign.run_test(test, index - 1)?.verdict)
    })?;
    let name = detector.name;
    let row = |trial: &Trial| {
        let longest =
            trial.robustness("detection").map_or(String::new(), |robustness| format!("{:.2}", 0.5 - robustness));
        format!(
            "{name},{},{},{},{longest}",
            trial.index,
            fields(study.space().parameters(), &trial.test),
            trial.verdict
        )
    };
    let failed = log.trials().iter().filter(|trial| trial.is_failure()).count();
    let mut text = format!("  pairs: {failed} of {} tests fail\n", log.trials().len());
    let mut guilty = Vec::new();
    let locations = located.iter().flat_map(|located| &located.locations);
    for location in locations.filter(|location| location.conclusion == Conclusion::Guilty) {
        let values =
            location.values.iter().map(|(name, value)| format!("{name} {value}")).collect::<Vec<_>>().join("; ");
        text += &format!("    guilty: {values}, behind {} failures\n", location.explains.len());
        guilty.push(format!("{name},{values},{}", location.explains.len()));
    }
    if let Some(located) = &located {
        text += &format!("    {} further tests; {} failures unexplained\n", located.ran, located.unexplained.len());
    }
    let columns = format!("detector,test,{},verdict,longest_unmatched_s", columns(study.space().parameters()));
    let tests = ("conditions-pairs.csv", columns, log.trials().iter().map(row).collect());
    Ok(Findings { parts: vec![tests, ("conditions-guilty.csv", "detector,values,failures".to_owned(), guilty)], text })
}
