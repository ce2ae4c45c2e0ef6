//! `paracosm-cover optimise`: searches for a set of points that makes a measure small, as CSV.

use super::spinner;
use super::time_limit;
use crate::cli::interrupt::Interruptible;
use crate::cli::output::{bracket, digits, plural};
use crate::cli::{Failure, Verbosity, complain, output_error, usage};
use crate::coverage::{Bracket, Deadline, Measure, PointSet};
use crate::generators::optimised::{Objective, Optimised, optimised};
use crate::space::Space;
use clap::Args;
use paracosm_campaign::TestSet;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  paracosm-cover optimise --measure star --dims 2 --budget 100 --time 30 > points.csv
  paracosm-cover optimise --measure dispersion --dims 3 --budget 50 --time 60 > points.csv
  paracosm-cover optimise --measure dispersion --from points.csv --time 60 > better.csv";

/// The options of `optimise`.
#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct Options {
    /// The measure to make small: star, dispersion or k-wise-dispersion
    #[arg(long, value_name = "M")]
    measure: Objective,
    /// The number of dimensions
    #[arg(long, value_name = "D", required_unless_present = "from")]
    dims: Option<usize>,
    /// The number of points
    #[arg(long, value_name = "N", required_unless_present = "from")]
    budget: Option<usize>,
    /// The seconds of the search
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    time: f64,
    /// Begin with the points in this file
    ///
    /// The columns are in [0,1]. The points that are printed are no worse.
    #[arg(long, value_name = "POINTS.csv")]
    from: Option<PathBuf>,
    /// The seed of the search, whose result also depends on the time
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// The number of coordinates that k-wise-dispersion looks at together [default: 2]
    #[arg(long, value_name = "K")]
    k: Option<usize>,
}

impl Options {
    pub fn execute(&self, verbosity: Verbosity) -> Result<(), Failure> {
        let limit = time_limit("--time", self.time)?;
        if self.k.is_some() && self.measure.measure() != Measure::K_WISE_DISPERSION {
            return Err(usage(format!(
                "--k belongs to the measure k-wise-dispersion, and --measure is {}",
                self.measure.measure()
            ))
            .into());
        }
        let given = self.from.as_deref().map(|path| self.given(path, verbosity)).transpose()?;
        let (space, given) = given.map_or((None, None), |(space, points)| (Some(space), Some(points)));
        let sizes = given.as_ref().map(|points| (points.len(), points.dims()));
        let (n, dims) = sizes.or(self.budget.zip(self.dims)).expect("clap asks for one of them");
        if n == 0 || dims == 0 {
            let (option, what) = if n == 0 { ("--budget", "point") } else { ("--dims", "dimension") };
            return Err(usage(format!("{option} is 0, expected at least one {what}")).into());
        }
        TestSet::check_size(n, dims)?;
        let space = space.unwrap_or_else(|| Space::unit_cube(dims));
        let objective = self.measure.for_points(dims, self.k).map_err(|flaw| usage(format!("--{flaw}")))?;
        let points = self.search(objective, (n, dims), given.as_ref(), limit, verbosity);
        write(&space, &points).map_err(output_error)?;
        if verbosity.quiet {
            return Ok(());
        }
        let measuring = Interruptible::new(Deadline::after(limit.max(MEASURING)));
        let value = objective.measured(&points, measuring.deadline);
        measuring.end();
        let label = objective.measure().descriptor().label;
        let of = format!("{} in {}", plural(n, "point"), plural(dims, "dimension"));
        verbosity.note(format_args!("{label} {} of {of}", in_full(&value)));
        Ok(())
    }

    /// Reads the points to begin with.
    fn given(&self, path: &Path, verbosity: Verbosity) -> Result<(Space, PointSet), Failure> {
        let TestSet { space, points, .. } = TestSet::read_points(path)?;
        let asked = [("--dims", self.dims, space.dims()), ("--budget", self.budget, points.len())];
        if let Some((option, asked, found)) = asked.iter().find_map(|(option, asked, found)| {
            Some((option, (*asked)?, *found)).filter(|(_, asked, found)| asked != found)
        }) {
            let message = format!("{option} is {asked}, and {} has {found}: leave {option} out", path.display());
            return Err(usage(message).into());
        }
        if points.is_empty() {
            return Err(usage(format!("{} has no points, expected at least one", path.display())).into());
        }
        let points = PointSet::new(space.dims(), points.into_iter().map(|point| point.continuous));
        let points = points.map_err(|flaw| usage(format!("{}: {flaw}", path.display())))?;
        verbosity.note(format_args!("beginning with {}", plural(points.len(), "point")));
        Ok((space, points))
    }

    fn search(
        &self,
        objective: Objective,
        size: (usize, usize),
        given: Option<&PointSet>,
        limit: Duration,
        verbosity: Verbosity,
    ) -> PointSet {
        let search = Interruptible::new(Deadline::after(limit));
        let label = objective.measure().descriptor().label;
        let seconds = limit.as_secs_f64();
        if size.1 > 1 {
            verbosity
                .note(format_args!("searching {seconds} s for a small {label}; Ctrl-C prints the best points so far"));
        }
        let bar = spinner("making the first points".to_owned(), verbosity);
        let watch = |value: f64| bar.set_message(format!("{label} {}", digits(value)));
        let Optimised { points, is_searched } = optimised(objective, size, given, self.seed, search.deadline, &watch);
        bar.finish_and_clear();
        if !is_searched {
            let (n, dims) = (plural(size.0, "point"), plural(size.1, "dimension"));
            complain(&format!(
                "the {label} of {n} in {dims} takes longer to measure than there was time, so these are the points to begin with; give more --time"
            ));
        }
        if search.end() {
            // More time may have made the measure smaller: the user has to know.
            complain(&"interrupted: these are the best points so far");
        }
        points
    }
}

/// The least time for measuring the points at the end.
const MEASURING: Duration = Duration::from_secs(2);

/// Prints a number with all its digits, or the bounds of a number.
fn in_full(value: &Bracket) -> String {
    if value.is_exact() { value.lower.to_string() } else { bracket(value) }
}

/// Writes points as CSV.
fn write(space: &Space, points: &PointSet) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(io::stdout().lock());
    csv.write_record(space.coordinates().map(|coordinate| coordinate.name()))?;
    for point in points.iter() {
        csv.write_record(point.iter().map(ToString::to_string))?;
    }
    csv.flush()
}
