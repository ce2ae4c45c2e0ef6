//! The figures of networks that drive: in fog and at other light, round a loop in fog, and behind leaders of two colours.

use super::outline::outline;
use super::plot::{Axis, BLUE, Bar, CURVES, Figure, GREEN, GREY, INK, Key, Layer, Mark, ORANGE, Panel};
use super::table::{Row, Table};
use paracosm::report::Tints;
use plotters::style::RGBColor;

/// The range of the distances that the shades show, in metres.
const COVERED: (f64, f64) = (85.0, 105.0);

fn shade(metres: f64) -> RGBColor {
    let [red, green, blue] = Tints::shade(metres, COVERED);
    RGBColor(red, green, blue)
}

fn fog() -> Axis {
    Axis::new("fog, and the visibility in it", (0.0, 1.0), 0.2).with_visibility()
}

/// The rows of a network.
fn of_network<'a>(table: &'a Table, seed: &'a str) -> impl Iterator<Item = Row<'a>> {
    table.rows().filter(move |row| row.word("seed") == seed)
}

/// The density of fog between two points of a curve of shares.
const STEP: f64 = 0.1;

/// Draws the distance that the first network covers over fog and light, and the share of the tests that fail over fog for
/// each network.
pub fn fog_and_light(tables: &[Table]) -> Figure {
    let tests = &tables[0];
    let seeds = tests.different("seed");
    let own = |seed| of_network(tests, seed);
    let at = |row: Row<'_>| (row.number("fog"), row.number("light"));
    let dots = own(seeds[0]).map(|row| (at(row).0, at(row).1, shade(row.number("travelled")))).collect();
    let failing = own(seeds[0]).filter(|row| row.word("verdict") == "fail").map(at).collect();
    let layers = vec![
        Layer::Tinted(dots, 36.0),
        Layer::Points(failing, Mark::Cross(24.0), ORANGE),
        Layer::Points(vec![(0.0, 1.0)], Mark::Ring(48.0), INK),
    ];
    let mut legend = vec![
        (Key::Mark(Mark::Cross(28.0), ORANGE), "(a) fails".to_owned()),
        (Key::Mark(Mark::Ring(40.0), INK), "(a) conditions of the training".to_owned()),
    ];
    let light = Axis::new("light", (0.0, 1.0), 0.2);
    let map = Panel { name: format!("(a) network {}", seeds[0]), x: fog(), y: light, layers };

    let mut layers = Vec::new();
    for (seed, colour) in seeds.iter().zip(CURVES) {
        let share = |i: usize| {
            let within = || own(seed).filter(|row| (row.number("fog") / STEP) as usize == i);
            let fails = within().filter(|row| row.word("verdict") == "fail").count();
            ((i as f64 + 0.5) * STEP, 100.0 * fails as f64 / within().count() as f64)
        };
        layers.push(Layer::Line((0..10).map(share).collect(), colour));
        legend.push((Key::Line(colour), format!("(b) network {seed}")));
    }
    let share = Axis::new("failing tests (%)", (0.0, 100.0), 20.0);
    let shares = Panel { name: "(b) each network, at any light".to_owned(), x: fog(), y: share, layers };
    let label = "distance covered (m)".to_owned();
    let bar = Bar { label, range: COVERED, ticks: vec![85.0, 90.0, 95.0, 100.0, 105.0], colour: shade };
    Figure { columns: 1, shape: 0.5, panels: vec![map, shares], legend, bar: Some(bar) }
}

/// Draws the time to the first failure of each kind over fog, and the steering over time in four densities.
pub fn fog_on_the_loop(tables: &[Table]) -> Figure {
    let [tests, steering] = tables else { panic!("two tables") };
    let curve = |column: &str, colour: RGBColor| {
        let points: Vec<(f64, f64)> = tests.rows().map(|row| (row.number("fog"), row.number(column))).collect();
        // A curve at the top has no dots: the event never occurs.
        let dots = points.iter().copied().filter(|point| point.1 < 200.0).collect();
        [Layer::Line(points, colour), Layer::Points(dots, Mark::Dot(22.0), colour)]
    };
    let mut layers: Vec<Layer> = curve("seconds_to_departure", ORANGE).into();
    layers.extend(curve("seconds_to_standstill", GREEN));
    let time = Axis::new("time (s)", (0.0, 200.0), 50.0);
    let first = Panel { name: "(a) until it is off its way, or stands".to_owned(), x: fog(), y: time, layers };

    let mut layers = Vec::new();
    let mut legend = vec![
        (Key::Line(ORANGE), "until it is 2 m off its way".to_owned()),
        (Key::Line(GREEN), "until it has stood for 10 s".to_owned()),
    ];
    let colours = [BLUE, CURVES[3], CURVES[4], INK];
    for (fog, colour) in steering.different("fog").into_iter().zip(colours) {
        let own = steering.rows().filter(|row| row.word("fog") == fog && row.number("time") <= 20.0);
        layers.push(Layer::Line(own.map(|row| (row.number("time"), row.number("steering"))).collect(), colour));
        legend.push((Key::Line(colour), format!("(b) fog {fog}")));
    }
    let steered = Axis::new("steering (share of full)", (-0.4, 0.1), 0.1);
    let second = Panel {
        name: "(b) how it steers, negative to the right".to_owned(),
        x: Axis::new("time (s)", (0.0, 20.0), 5.0),
        y: steered,
        layers,
    };
    Figure { columns: 1, shape: 0.36, panels: vec![first, second], legend, bar: None }
}

/// Draws the speed behind leaders of 8 and of 4 m/s: of the first network in three cases, and of the other networks behind
/// the white leader.
pub fn leaders(tables: &[Table]) -> Figure {
    let speeds = &tables[0];
    let (seeds, cases) = (speeds.different("seed"), speeds.different("case"));
    let own = |seed: &str, case: &str, leader: &str| {
        let own =
            |row: &Row<'_>| [row.word("seed"), row.word("case"), row.word("leader_speed")] == [seed, case, leader];
        speeds.rows().filter(own).collect::<Vec<_>>()
    };
    let over_time = |rows: &[Row<'_>]| rows.iter().map(|row| (row.number("time"), row.number("speed"))).collect();
    let panels = ["8", "4"].into_iter().zip(['a', 'b']).map(|(leader, letter)| {
        let other = |seed: &&str| Layer::Line(over_time(&own(seed, "white leader", leader)), GREY);
        let mut layers: Vec<Layer> = seeds[1..].iter().map(other).collect();
        for (case, colour) in cases.iter().zip(CURVES) {
            let own = own(seeds[0], case, leader);
            layers.push(Layer::Line(over_time(&own), colour));
            let passing = own.iter().find(|row| row.number("oncoming_gap") <= 0.0);
            let passing = passing.map(|row| (row.number("time"), row.number("speed")));
            layers.push(Layer::Points(passing.into_iter().collect(), Mark::Dot(30.0), INK));
        }
        // A test that ends early has ended in a collision.
        let ends = seeds.iter().flat_map(|seed| cases.iter().map(|case| own(seed, case, leader)));
        let ends = ends.filter_map(|rows| rows.last().map(|row| (row.number("time"), row.number("speed"))));
        layers.push(Layer::Points(ends.filter(|end| end.0 < 14.5).collect(), Mark::Cross(40.0), INK));
        Panel {
            name: format!("({letter}) leader of {leader} m/s"),
            x: Axis::new("time (s)", (0.0, 15.0), 5.0),
            y: Axis::new("speed (m/s)", (0.0, 16.0), 4.0),
            layers,
        }
    });
    let panels = panels.collect();
    let mut legend: Vec<(Key, String)> =
        cases.iter().zip(CURVES).map(|(case, colour)| (Key::Line(colour), (*case).to_owned())).collect();
    legend.push((Key::Line(GREY), "white leader, other networks".to_owned()));
    legend.push((Key::Mark(Mark::Dot(30.0), INK), "the red car passes".to_owned()));
    legend.push((Key::Mark(Mark::Cross(40.0), INK), "collision".to_owned()));
    Figure { columns: 1, shape: 0.36, panels, legend, bar: None }
}

/// The change of the throttle that has the full colour.
const CHANGE: f64 = 0.4;

/// The colour of a change of the throttle: orange for more power, blue for less, white for none.
fn change(value: f64) -> RGBColor {
    let share = (value.abs() / CHANGE).min(1.0);
    let full = if value > 0.0 { ORANGE } else { BLUE };
    let channel = |full: u8| (255.0 + share * (f64::from(full) - 255.0)).round() as u8;
    RGBColor(channel(full.0), channel(full.1), channel(full.2))
}

/// Draws how covering each place of an image changes the throttle, all on one scale.
pub fn saliency(tables: &[Table]) -> Figure {
    let maps = &tables[0];
    let names = maps.different("what");
    let panels = names.iter().zip('a'..).map(|(name, letter)| {
        let own = || maps.rows().filter(|row| row.word("what") == *name);
        let [width, height] =
            ["column", "row"].map(|column| own().map(|row| row.number(column)).fold(0.0, f64::max) + 1.0);
        // Neighbours in a row that have the same of a few shades are one rectangle.
        let shade = |row: Row<'_>| (40.0 * row.number("throttle") / CHANGE).round() / 40.0 * CHANGE;
        let mut layers: Vec<Layer> = Vec::new();
        let mut run: Option<(f64, f64, f64, f64)> = None;
        let mut close = |run: (f64, f64, f64, f64)| {
            let (y, from, to, value) = run;
            layers.push(Layer::Cells(vec![[(from, height - y), (to, height - y - 1.0)]], change(value)));
        };
        for row in own() {
            let (x, y, value) = (row.number("column"), row.number("row"), shade(row));
            match &mut run {
                Some((at, _, to, of)) if *at == y && *of == value => *to = x + 1.0,
                _ => {
                    if let Some(done) = run.replace((y, x, x + 1.0, value)) {
                        close(done);
                    }
                }
            }
        }
        run.into_iter().for_each(&mut close);
        let leader: Vec<bool> = own().map(|row| row.word("leader") == "1").collect();
        let size = [width, height].map(|side| side as usize);
        let corner = |i: usize, j: usize| (i as f64, height - j as f64);
        let border = outline(size, |i, j| leader[j * size[0] + i], corner);
        layers.extend(border.into_iter().map(|piece| Layer::Line(piece, INK)));
        let what = if *name == "red rectangle" { "nobody, a red rectangle" } else { name };
        Panel {
            name: format!("({letter}) {what}"),
            x: Axis::new("column (pixels)", (0.0, width), 20.0),
            y: Axis::new("row (pixels)", (0.0, height), 20.0),
            layers,
        }
    });
    let panels = panels.collect();
    let legend = vec![(Key::Line(INK), "border of the leader".to_owned())];
    let label = "change of the throttle".to_owned();
    let bar = Bar { label, range: (-CHANGE, CHANGE), ticks: vec![-0.4, -0.2, 0.0, 0.2, 0.4], colour: change };
    Figure { columns: 2, shape: 0.56, panels, legend, bar: Some(bar) }
}

/// Draws the throttle over the gap to what may be taken for a leader.
pub fn gaps(tables: &[Table]) -> Figure {
    let throttle = &tables[0];
    let curves = [
        ("red_leader", "red leader"),
        ("white_leader", "white leader"),
        ("red_other_lane", "red, on the other lane"),
        ("red_on_the_grass", "red, on the grass"),
        ("bare_red_rectangle", "bare red rectangle"),
        ("nobody", "nobody"),
    ];
    let layers = curves.iter().zip(CURVES).map(|((column, _), colour)| {
        Layer::Line(throttle.rows().map(|row| (row.number("gap"), row.number(column))).collect(), colour)
    });
    let layers = layers.collect();
    let legend = curves.iter().zip(CURVES).map(|((_, name), colour)| (Key::Line(colour), (*name).to_owned())).collect();
    let x = Axis::new("gap (m)", (0.0, 30.0), 10.0);
    let panels = vec![Panel { name: String::new(), x, y: Axis::new("throttle", (-1.0, 0.5), 0.5), layers }];
    Figure { columns: 1, shape: 0.45, panels, legend, bar: None }
}
