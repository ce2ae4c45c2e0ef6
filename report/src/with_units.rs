//! The values of a test in words, with their units.

use paracosm_campaign::Study;
use paracosm_space::{Values, digits};

/// Returns the values of a test, such as `speed 2.5 m/s, lanes 4`.
pub(crate) fn with_units(study: &Study, test: &Values) -> String {
    let values = study.space().parameters().iter().zip(test.iter()).map(|(parameter, (name, value))| {
        let value = value.number().map_or_else(|| value.to_string(), digits);
        format!("{name} {value} {}", parameter.unit.as_deref().unwrap_or_default()).trim_end().to_owned()
    });
    values.collect::<Vec<_>>().join(", ")
}
