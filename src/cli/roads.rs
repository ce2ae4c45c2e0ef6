//! `paracosm-fuzz roads`: shows what was read from a file of roads, and draws it.

use super::draw::{FileKind, Target};
use super::output::{Format, FormatOption, Table, digits, json, plural};
use super::usage;
use super::{Failure, Status, Verbosity, print};
use crate::engine::road::{Lane, RoadNetwork};
use crate::standards::opendrive::{Map, Section, borders};
use clap::Args;
use paracosm_campaign::Error;
use paracosm_report::{birds_eye::RoadPicture, plot};
use serde_json::json;
use std::path::PathBuf;

pub(super) const EXAMPLES: &str = "\
Examples:
  paracosm-fuzz roads town.xodr
      roads, junctions and lanes, and everything that has no effect
  paracosm-fuzz roads town.xodr --draw town.svg
      the roads from above
  paracosm-fuzz roads town.xodr --lanes lanes.csv --step 0.5
      points on the outer border of every lane

The file is ASAM OpenDRIVE, version 1.4 to 1.8. docs/opendrive.md lists the elements that are supported.

Exit status: 0 done; 2 wrong use, or a file that is not valid.";

/// The options of `roads`.
#[derive(Debug, Args)]
pub(super) struct Options {
    /// The file of roads
    #[arg(value_name = "FILE.xodr")]
    file: PathBuf,
    /// Draw the roads from above to a file: .svg or .png
    #[arg(long, value_name = "FILE")]
    draw: Option<PathBuf>,
    /// Write points on the outer borders of all lanes to a file: .csv
    #[arg(long, value_name = "FILE")]
    lanes: Option<PathBuf>,
    /// The distance between two points on a border, in metres
    #[arg(long, value_name = "M", default_value_t = 1.0, requires = "lanes")]
    step: f64,
    #[command(flatten)]
    form: FormatOption,
}

/// The least distance between two points on a border in metres, and the greatest number of points.
const LEAST_STEP: f64 = 0.001;
const MOST_POINTS: f64 = 2e7;

impl Options {
    pub fn execute(&self, verbosity: Verbosity) -> Result<Status, Failure> {
        let inputs = [self.file.as_path()];
        let draw = self.draw.as_ref().map(|file| Target::new("--draw", file, &[FileKind::Svg, FileKind::Png], &inputs));
        let lanes = self.lanes.as_ref().map(|file| Target::new("--lanes", file, &[FileKind::Csv], &inputs));
        let (draw, lanes) = (draw.transpose()?, lanes.transpose()?);
        if !(self.step >= LEAST_STEP && self.step.is_finite()) {
            return Err(usage(format!("--step is {}, expected at least {LEAST_STEP} m", self.step)).into());
        }
        let map = Map::read(&self.file)?;
        let network = map.network().map_err(|error| usage(format!("{}: {error}", self.file.display())))?;
        if lanes.is_some() {
            self.check_points(&map)?;
        }
        if let Some(target) = &draw {
            verbosity.note(target.write(|kind| {
                let things = map.objects().flat_map(|object| &object.parts);
                let picture = things.fold(RoadPicture::of(&network), |picture, (body, at)| picture.thing(*body, *at));
                let drawing = picture.drawing();
                match kind {
                    FileKind::Svg => Ok(drawing.svg().into_bytes()),
                    _ => plot::drawing_png(&drawing),
                }
            })?);
        }
        if let Some(target) = &lanes {
            verbosity.note(target.write(|_| Ok(self.csv(&map)?))?);
        }
        let text = match self.form.format {
            Format::Table => self.table(&map, &network),
            Format::Json => self.as_json(&map, &network),
        };
        print(&text).map(|()| Status::Nothing)
    }

    /// Refuses a step that gives too many points, before anything is written.
    fn check_points(&self, map: &Map) -> Result<(), Error> {
        let sections = map.roads.iter().flat_map(|road| &road.sections);
        let of_one = |of: &Section| of.lanes.len() as f64 * ((of.end - of.s) / self.step + 2.0);
        let points: f64 = sections.map(of_one).sum();
        if points > MOST_POINTS {
            let step = self.step;
            return Err(usage(format!("--step {step} gives {points:.0} points, expected at most {MOST_POINTS}")));
        }
        Ok(())
    }

    fn csv(&self, map: &Map) -> Result<Vec<u8>, csv::Error> {
        let mut csv = csv::Writer::from_writer(Vec::new());
        csv.write_record(["road", "section", "lane", "type", "s", "x", "y", "z", "heading"])?;
        for border in borders(map, self.step) {
            let [x, y, z] = border.at;
            let [section, lane] = [border.section.to_string(), border.lane.to_string()];
            let numbers = [border.s, x, y, z, border.heading].map(|number| format!("{number:.6}"));
            let [s, x, y, z, heading] = numbers.each_ref().map(String::as_str);
            csv.write_record([border.road, &section, &lane, border.kind, s, x, y, z, heading])?;
        }
        csv.into_inner().map_err(|error| csv::Error::from(error.into_error()))
    }

    fn notes(&self, map: &Map) -> impl Iterator<Item = String> {
        map.notes.iter().map(|note| note.in_file(&self.file))
    }

    fn as_json(&self, map: &Map, network: &RoadNetwork) -> String {
        let bounds = network.bounds();
        json(&json!({
            "file": self.file, "roads": map.roads.len(), "junctions": map.junctions.len(),
            "lanes": network.lanes().len(), "road_metres": road_metres(map), "lane_metres": lane_metres(network),
            "objects": map.objects().count(), "bodies": bodies(map),
            "bounds": {"min": bounds.min.as_slice(), "max": bounds.max.as_slice()},
            "notes": self.notes(map).collect::<Vec<_>>(),
        }))
    }

    fn table(&self, map: &Map, network: &RoadNetwork) -> String {
        let mut table = Table::default();
        let roads = plural(map.roads.len(), "road");
        table.heading(&format!("{roads}, {}", plural(map.junctions.len(), "junction")));
        table.row("roads", &format!("{} m", digits(road_metres(map))));
        let lanes = network.lanes();
        table.row("driven lanes", &format!("{}, {} m", lanes.len(), digits(lane_metres(network))));
        let ends = lanes.iter().filter(|lane| lane.successors.is_empty()).count();
        table.row("without a next lane", &ends.to_string());
        if map.objects().next().is_some() {
            table.row("objects and signals", &format!("{}, {} with a body", map.objects().count(), bodies(map)));
        }
        let extent = network.bounds().max - network.bounds().min;
        table.row("extent", &format!("{} m by {} m", digits(extent.x), digits(extent.y)));
        if !map.notes.is_empty() {
            table.heading("notes");
            self.notes(map).for_each(|note| table.row("", &note));
        }
        table.finish()
    }
}

fn road_metres(map: &Map) -> f64 {
    map.roads.iter().map(|road| road.length).sum()
}

/// Returns the number of objects and signals that have a body.
fn bodies(map: &Map) -> usize {
    map.objects().filter(|object| !object.parts.is_empty()).count()
}

fn lane_metres(network: &RoadNetwork) -> f64 {
    network.lanes().iter().map(Lane::length).sum()
}
