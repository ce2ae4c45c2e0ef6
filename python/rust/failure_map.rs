//! `FailureMap`: where in the plane of two parameters tests fail.

use crate::error::raised;
use crate::table::Table;
use paracosm::analysis::{Effects, Impacts, explanation, failure_estimate};
use paracosm::campaign::JsonArtefact;
use paracosm::campaign::files::write_whole_here;
use paracosm::report::{FailureMap as Drawn, Picture};
use paracosm::{Log, analysis};
use pyo3::prelude::*;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// A map of failures, or of the speeds of impacts, over two continuous parameters.
///
/// A notebook shows the map as a picture. `map.save("map.png")` writes it, also as `.svg`, and the estimate behind it as `.csv`.
#[pyclass(frozen, module = "paracosm")]
pub struct FailureMap {
    drawn: Drawn,
    axes: [String; 2],
}

impl FailureMap {
    /// Makes the map of a campaign in a folder over the named parameters. The parameters that separate failing tests from passing tests best take
    /// the place of names that are not given.
    ///
    /// # Errors
    /// A name does not belong to a continuous parameter, the campaign has fewer than two, or there is nothing to show.
    pub fn of(log: &Log, folder: &Path, names: [Option<&str>; 2], show: &str) -> PyResult<Self> {
        let found = explanation::axes(log, names).map_err(raised)?;
        let axes =
            found.ok_or_else(|| raised("a map needs two open continuous parameters, and this campaign has fewer"))?;
        let both = [&axes[0], &axes[1]].map(String::as_str);
        failure_estimate::axes(log.study(), both).map_err(raised)?;
        let drawn = match show {
            "failures" => Drawn::over(log, both).map_err(raised)?,
            "severity" if Impacts::of(log).is_some() => Drawn::of_severity(log, both).map_err(raised)?,
            "severity" => {
                return Err(raised("no test of this campaign has a contact, so that there is no impact speed to show"));
            }
            _ => return Err(raised(format!("show is \"{show}\", expected \"failures\" or \"severity\""))),
        };
        let effects = Effects::read(folder).map_err(raised)?;
        Ok(Self { drawn: effects.iter().fold(drawn, Drawn::noting), axes })
    }

    fn picture(&self) -> Picture {
        Picture::of(self.drawn.clone())
    }

    fn known(&self) -> PyResult<&analysis::FailureEstimate> {
        self.drawn
            .estimate
            .as_ref()
            .ok_or_else(|| raised("nothing is estimated: an estimate needs a failing test and a passing test"))
    }
}

#[pymethods]
impl FailureMap {
    /// The names of the parameters on the horizontal and on the vertical axis.
    #[getter]
    fn axes(&self) -> (&str, &str) {
        (&self.axes[0], &self.axes[1])
    }

    /// The estimated share of the map in which tests fail; `None` if nothing is estimated, because no test failed or none passed.
    #[getter]
    fn failing(&self) -> Option<f64> {
        self.drawn.estimate.as_ref().map(analysis::FailureEstimate::mean)
    }

    /// The share of the map that all plausible settings of the estimate decide in the same way; `None` if nothing is estimated.
    #[getter]
    fn decided(&self) -> Option<f64> {
        self.drawn.estimate.as_ref().map(analysis::FailureEstimate::decided)
    }

    /// The estimate behind the map: a table with the columns of `failure-map.csv`.
    ///
    /// Raises `Error` if nothing is estimated.
    #[getter]
    fn estimate(&self) -> PyResult<Table> {
        let text = String::from_utf8(self.known()?.csv()).map_err(raised)?;
        Ok(Table::of_texts(text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()))
    }

    /// Writes the map to a file: `.svg`, `.png`, or `.csv` for the estimate.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        let contents = match path.extension().and_then(OsStr::to_str) {
            Some("svg") => self.svg()?.into_bytes(),
            Some("png") => self.picture().png().map_err(raised)?,
            Some("csv") => self.known()?.csv(),
            _ => return Err(raised(format!("found {}, expected a file .svg, .png or .csv", path.display()))),
        };
        write_whole_here(&path, &contents).map_err(raised)
    }

    /// Returns the picture as SVG.
    fn svg(&self) -> PyResult<String> {
        self.picture().svg().map_err(raised)
    }

    /// Returns the picture as PNG, for notebooks.
    fn _repr_png_(&self) -> PyResult<std::borrow::Cow<'static, [u8]>> {
        Ok(self.picture().png().map_err(raised)?.into())
    }

    fn __repr__(&self) -> String {
        format!("FailureMap({} and {}: {})", self.axes[0], self.axes[1], self.drawn.note)
    }
}
