//! The figures of networks that see: lenses, vehicles on a highway, and conditions.

use super::plot::{Axis, BLUE, CURVES, Figure, GREY, Key, Layer, Mark, ORANGE, Panel};
use super::table::Table;

/// Draws the shares of pixels over the focal length, with the mean and the range of five networks of each course.
pub fn lenses(tables: &[Table]) -> Figure {
    let networks = &tables[0];
    let lengths = networks.different("focal_mm");
    let courses = [("one-length", "taught at 34 mm", ORANGE), ("all-lengths", "taught at 10 to 50 mm", BLUE)];
    let shares = [
        ("true_positives", "(a) true positives", (96.0, 100.0), 1.0),
        ("false_positives", "(b) false positives", (0.0, 20.0), 5.0),
        ("overlap", "(c) overlap", (70.0, 100.0), 10.0),
    ];
    let panels = shares.into_iter().map(|(column, name, range, step)| {
        let mut layers = Vec::new();
        for (course, _, colour) in courses {
            let mut band = Vec::new();
            for length in &lengths {
                let own = networks.rows().filter(|row| row.word("course") == course && row.word("focal_mm") == *length);
                let values: Vec<f64> = own.map(|row| 100.0 * row.number(column)).collect();
                let [low, high] = [f64::min, f64::max].map(|of| values.iter().copied().reduce(of).unwrap_or(f64::NAN));
                let mean = values.iter().sum::<f64>() / values.len() as f64;
                band.push((length.parse().unwrap_or(f64::NAN), low, high, mean));
            }
            layers.push(Layer::Band(band.iter().map(|(x, low, high, _)| (*x, *low, *high)).collect(), colour));
            layers.push(Layer::Line(band.iter().map(|(x, _, _, mean)| (*x, *mean)).collect(), colour));
        }
        let x = Axis::new("focal length (mm)", (10.0, 50.0), 10.0);
        Panel { name: name.to_owned(), x, y: Axis::new("share (%)", range, step), layers }
    });
    let panels = panels.collect();
    let legend = courses.map(|(_, name, colour)| (Key::Line(colour), name.to_owned())).into();
    Figure { columns: 1, shape: 0.3, panels, legend, bar: None }
}

/// Draws the visible and the found vehicles along the way, a panel for each detector.
pub fn vehicles(tables: &[Table]) -> Figure {
    let images = &tables[0];
    let panels = images.different("detector").into_iter().zip('a'..).map(|(detector, letter)| {
        let own = || images.rows().filter(|row| row.word("detector") == detector);
        let curve = |column: &str| own().map(|row| (row.number("travelled_m"), row.number(column))).collect::<Vec<_>>();
        let truck = |word: &str| {
            own()
                .filter(|row| row.word("truck") == word)
                .map(|row| (row.number("travelled_m"), 12.0))
                .collect::<Vec<_>>()
        };
        Panel {
            name: format!("({letter}) {detector}"),
            x: Axis::new("distance (m)", (0.0, 250.0), 100.0),
            y: Axis::new("vehicles in an image", (0.0, 13.0), 4.0),
            layers: vec![
                Layer::Line(curve("visible"), GREY),
                Layer::Line(curve("found"), BLUE),
                Layer::Dashed(curve("false_alarms"), ORANGE),
                Layer::Points(truck("missed"), Mark::Cross(20.0), ORANGE),
                Layer::Points(truck("found"), Mark::Dot(24.0), BLUE),
            ],
        }
    });
    let panels = panels.collect();
    let legend = vec![
        (Key::Line(GREY), "visible".to_owned()),
        (Key::Line(BLUE), "found".to_owned()),
        (Key::Dashed(ORANGE), "false alarms".to_owned()),
        (Key::Mark(Mark::Dot(24.0), BLUE), "truck found".to_owned()),
        (Key::Mark(Mark::Cross(20.0), ORANGE), "truck missed".to_owned()),
    ];
    Figure { columns: 2, shape: 0.42, panels, legend, bar: None }
}

/// Draws the recall of each detector over fog, light and focal length.
pub fn conditions(tables: &[Table]) -> Figure {
    let paired = &tables[0];
    let detectors = paired.different("detector");
    let conditions = [
        ("fog", Axis::new("fog, and the visibility in it", (0.0, 0.3), 0.1).with_visibility()),
        ("light", Axis::new("light", (0.0, 1.0), 0.2)),
        ("camera.front.focal_mm", Axis::new("focal length (mm)", (14.0, 50.0), 12.0)),
    ];
    let panels = conditions.into_iter().zip('a'..).map(|((condition, x), letter)| {
        let curves = detectors.iter().zip(CURVES).flat_map(|(detector, colour)| {
            let own =
                paired.rows().filter(|row| row.word("detector") == *detector && row.word("condition") == condition);
            let mut points: Vec<(f64, f64)> =
                own.map(|row| (row.number("value"), 100.0 * row.number("recall"))).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            [Layer::Line(points.clone(), colour), Layer::Points(points, Mark::Dot(20.0), colour)]
        });
        let layers = curves.collect();
        Panel { name: format!("({letter})"), x, y: Axis::new("recall (%)", (0.0, 100.0), 25.0), layers }
    });
    let panels = panels.collect();
    let legend =
        detectors.iter().zip(CURVES).map(|(detector, colour)| (Key::Line(colour), (*detector).to_owned())).collect();
    Figure { columns: 1, shape: 0.32, panels, legend, bar: None }
}
