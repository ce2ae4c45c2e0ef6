//! Draws the figures of the pages from the CSV files of the studies, without running a study.

mod covered;
mod crossing;
mod driven;
mod outline;
mod plot;
mod seen;
pub mod table;

use crate::{Done, print, write};
use indicatif::ProgressBar;
use plot::Figure;
use std::error::Error;
use std::path::Path;
use table::Table;

/// A file of a study.
macro_rules! file {
    ($name:literal) => {
        include_bytes!(concat!("../../data/", $name))
    };
}

type Drawing = fn(&[Table]) -> Figure;

/// The figures: the name, the files of data, and the drawing.
const FIGURES: [(&str, &[&[u8]], Drawing); 13] = [
    ("fig9", &[file!("fig9-tests.csv.gz"), file!("fig9-reference.csv.gz")], crossing::samples),
    ("fig9-cnn", &[file!("fig9-cnn-tests.csv"), file!("fig9-cnn-reference.csv")], crossing::samples),
    ("fig9-cnn-reference", &[file!("fig9-cnn-reference.csv"), file!("fig9-cnn-drivers.csv")], crossing::map),
    ("fig10a", &[file!("fig10a.csv")], driven::fog_and_light),
    ("fig10b", &[file!("fig10b.csv"), file!("fig10b-steering.csv")], driven::fog_on_the_loop),
    ("fig10c", &[file!("fig10c-speeds.csv.gz")], driven::leaders),
    ("saliency", &[file!("saliency-maps.csv.gz")], driven::saliency),
    ("saliency-gap", &[file!("saliency-gap.csv")], driven::gaps),
    ("samplers", &[file!("samplers-sets.csv.gz")], covered::samplers),
    ("audit", &[file!("audit.csv")], covered::suites),
    ("fig6", &[file!("fig6.csv")], seen::lenses),
    ("fig8", &[file!("fig8.csv")], seen::vehicles),
    ("conditions", &[file!("conditions-paired.csv")], seen::conditions),
];

/// Draws all figures into a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    bar.finish_and_clear();
    for (name, files, draw) in FIGURES {
        write(&out.join(format!("{name}.svg")), drawn(files, draw)?)?;
        print(&format!("{name}.svg\n"))?;
    }
    Ok(())
}

/// Returns a figure as the text of an SVG file.
fn drawn(files: &[&[u8]], draw: Drawing) -> Result<String, Box<dyn Error + Send + Sync>> {
    let tables = files.iter().map(|file| Table::read(file)).collect::<Result<Vec<_>, _>>()?;
    draw(&tables).svg()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::{env, fs};

    #[test]
    fn the_figures_of_the_pages_are_drawn_from_the_data_with_text_that_a_column_of_a_paper_shows() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("figures");
        let is_update = env::var_os("UPDATE_GOLDEN").is_some_and(|update| update == "1");
        let figures = FIGURES.map(|(name, files, draw)| (name, drawn(files, draw).unwrap()));
        if is_update {
            figures.iter().for_each(|(name, svg)| fs::write(folder.join(format!("{name}.svg")), svg).unwrap());
        }
        for (name, svg) in figures {
            let old = fs::read_to_string(folder.join(format!("{name}.svg"))).unwrap();
            assert!(old == svg, "{name}.svg is old; UPDATE_GOLDEN=1 draws all figures again");
            // At a width of 8.5 cm, which is 241 points, a text of this size has six points.
            let least = plot::width() * 6.0 / 241.0;
            let sizes = svg.split("font-size=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
            let sizes: Vec<f64> = sizes.map(|size| size.parse().unwrap()).collect();
            assert!(!sizes.is_empty() && sizes.iter().all(|size| *size >= least - 1.0), "{name}: {sizes:?}, {least}");
        }
    }
}
