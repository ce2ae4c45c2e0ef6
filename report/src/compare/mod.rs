//! Writes up a comparison as tables, figures, LaTeX and CSV.

mod figures;
mod files;
mod latex;
mod table;

pub use files::{set_rows, slope_rows, summary_rows, write};
pub use table::table;
