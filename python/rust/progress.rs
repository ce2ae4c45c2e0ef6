//! The progress of long work: a function of the user's, or a line in a terminal or a notebook.

use crate::error::raised;
use crate::value::is_truth;
use pyo3::prelude::*;

/// The way in which work tells how much of it is done.
pub struct Progress {
    /// `None` without progress.
    tell: Option<Py<PyAny>>,
    /// `true` if the line of this package is shown, which has an end.
    is_line: bool,
    told: Option<usize>,
}

impl Progress {
    /// Reads the choice of a user: a function; `None` for a line in a terminal or a notebook; `False` for no progress.
    ///
    /// # Errors
    /// The object is neither a function nor `False`.
    pub fn of(py: Python, found: Option<&Bound<PyAny>>) -> PyResult<Self> {
        let new = |tell, is_line| Self { tell, is_line, told: None };
        match found {
            Some(found) if found.is_callable() => Ok(new(Some(found.clone().unbind()), false)),
            Some(found) if is_truth(found) && !found.is_truthy()? => Ok(new(None, false)),
            Some(found) if !is_truth(found) => Err(raised(format!(
                "progress is {}, expected a function that gets the numbers of what is done and of all, or False for none",
                found.repr()?
            ))),
            _ => {
                let line = py.import("paracosm._progress")?.call_method0("usual")?;
                Ok(new((!line.is_none()).then(|| line.unbind()), true))
            }
        }
    }

    /// Tells how much is done, if it is more than before.
    ///
    /// # Errors
    /// The function of the user raised an exception.
    pub fn tell(&mut self, py: Python, done: usize, all: usize) -> PyResult<()> {
        let Some(tell) = self.tell.as_ref().filter(|_| self.told != Some(done)) else { return Ok(()) };
        self.told = Some(done);
        tell.call1(py, (done, all)).map(drop)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(line) = self.tell.as_ref().filter(|_| self.is_line) {
            // A terminal that is gone needs no end of the line.
            let _ = Python::attach(|py| line.call_method0(py, "end"));
        }
    }
}
