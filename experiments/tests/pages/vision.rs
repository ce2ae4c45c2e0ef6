//! Computes the numbers of the pages on networks that see: Figures 5 to 8, and the recall of detectors.

use crate::page::Page;
use crate::rows::{Row, count, different, mean, number, numbers_of, range, rows};
use std::fmt::Write;

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

#[test]
fn the_numbers_of_the_page_on_figure_6_follow_from_its_networks() {
    let networks = rows(include_bytes!("../../data/fig6.csv"));
    let of = |course: &str, length: &str, column: &str| {
        numbers_of(&networks, column, |row| row["course"] == course && row["focal_mm"] == length)
    };
    let courses = ["one-length", "all-lengths"];
    let mut page = Page::open("fig6.md");
    let mut table = String::from(
        "| focal length in mm | true positives, taught at 34 mm | false positives | overlap | true positives, taught at 10 to 50 mm | \
         false positives | overlap |\n| --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for length in ["10", "14", "20", "26", "34", "42", "50"] {
        write!(table, "| {length} |").unwrap();
        for course in courses {
            for column in ["true_positives", "false_positives", "overlap"] {
                let shares = of(course, length, column);
                assert_eq!(shares.len(), 5);
                let [least, most] = range(shares.iter().copied());
                write!(table, " {} ({} to {}) |", percent(mean(&shares)), percent(least), percent(most)).unwrap();
            }
        }
        table.push('\n');
    }
    page.table("lengths", &table);

    let lengths = different(&networks, "focal_mm");
    page.says(format!("at {} focal lengths from {} to {} mm", lengths.len(), lengths[0], lengths[lengths.len() - 1]));
    page.says(format!("seven of the {} lengths", lengths.len()));
    let spread = |course: &str, length: &str| {
        let [least, most] = range(of(course, length, "overlap"));
        most - least
    };
    let [_, widest] = range(courses.iter().flat_map(|course| lengths.iter().map(|length| spread(course, length))));
    page.says(format!("the overlaps of the networks of one course differ by at most {} points", percent(widest)));
    let [before, after] = courses.map(|course| percent(mean(&of(course, "10", "false_positives"))));
    page.says(format!("lessons with all lengths reduce the false positives from {before} to {after} %"));
    let long = lengths.iter().filter(|length| length.parse::<f64>().unwrap() >= 20.0);
    let cost = long.map(|length| mean(&of(courses[0], length, "overlap")) - mean(&of(courses[1], length, "overlap")));
    let [least, most] = range(cost);
    page.says(format!("From 20 mm on they cost {} to {} points of overlap", percent(least), percent(most)));
    page.given(&[
        "# Figures 5 and 6:",
        "`truck_delay` 8 s, `truck_speed` 8 m/s, `traffic_seed` 1",
        "of the 1,770 pixels that the network at 10 mm in Figure 5 falsely takes for road, 1,616 lie on the bonnet",
    ]);
    page.given(&[
        "another lens? Networks that were taught at 34 mm take more and more of other things for road below 20 mm",
    ]);
    page.given(&[
        "on a sensor of 36 mm, with 160 x 96 pixels and an image each second",
        "at 34 mm, and five with focal lengths from 10 to 50 mm",
    ]);
    page.given(&[
        "Figure 5 shows one moment at 10, 20, 34 and 50 mm",
        "taught at 34 mm, and the answer of the first network that was taught at 10 to 50 mm",
    ]);
    page.given(&[
        "Agrees for false positives below 20 mm",
        "At 10 mm, lessons",
        "At 50 mm, cars and markings are five times as large as at 10 mm",
    ]);
    page.close();
}

#[test]
fn the_numbers_of_the_page_on_figure_8_follow_from_its_images() {
    let images = rows(include_bytes!("../../data/fig8.csv"));
    let mut page = Page::open("fig8.md");
    let mut table = String::from(
        "| detector | threshold | visible | found | false alarms | truck visible | truck found |\n\
         | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let detectors = different(&images, "detector");
    let mut all = Vec::new();
    for detector in &detectors {
        let own: Vec<Row> = images.iter().filter(|row| row["detector"] == *detector).cloned().collect();
        let sum = |column: &str| numbers_of(&own, column, |_| true).iter().sum::<f64>();
        let [shown, found] = [count(&own, |row| !row["truck"].is_empty()), count(&own, |row| row["truck"] == "found")];
        let [visible, finds, alarms] = ["visible", "found", "false_alarms"].map(sum);
        let threshold = number(&own[0], "threshold");
        writeln!(table, "| `{detector}` | {threshold:.2} | {visible} | {finds} | {alarms} | {shown} | {found} |")
            .unwrap();
        all.push((visible, finds, shown, found));
    }
    page.table("detectors", &table);
    let [best, trucks] =
        [all.iter().map(|one| one.1 as usize).max().unwrap(), all.iter().map(|one| one.3).max().unwrap()];
    let (visible, shown) = (all[0].0, all[0].2);
    page.says(format!("The best of six detectors finds {best} of {visible} vehicles. Another one finds the truck in {trucks} of {shown} images"));
    let found: Vec<String> = all.iter().map(|one| one.3.to_string()).collect();
    let (last, first) = found.split_last().unwrap();
    page.says(format!("the six detectors find it in {} and {last} of {shown} images", first.join(", ")));
    let [own, ahead] =
        ["single-shot", "single-shot-ahead"].map(|name| all[detectors.iter().position(|d| *d == name).unwrap()].3);
    page.says(format!("never finds the truck, and `single-shot` finds it in {own} images"));
    assert_eq!(ahead, 0);
    let coco = images.iter().find(|row| row["detector"] == "ssd-coco").unwrap();
    page.says(format!("`ssd-coco` needs {:.2} for 0.1 false alarms an image", number(coco, "threshold")));
    page.given(&[
        "# Figures 7 and 8:",
        "`truck_delay` 5 s, `truck_speed` 8 m/s",
        "Every 10 m it takes an image of 640 x 384 pixels",
        "with a focal length of 24 mm on a sensor of 36 mm",
    ]);
    page.given(&[
        "if it is at least 8 pixels high",
        "overlap by 0.5 (intersection over union)",
        "191 images, against 1,202 of",
    ]);
    page.given(&[
        "vehicles of 40 pixels in height",
        "on 149 images of easy scenes",
        "at most 0.1 false alarms an image",
        "shows the image after 210 m",
    ]);
    page.close();
}

#[test]
fn the_numbers_of_the_page_on_recall_follow_from_its_boxes() {
    let sizes = rows(include_bytes!("../../data/recall.csv"));
    let mut page = Page::open("recall.md");
    let mut table = String::from(
        "| detector | pixels of | threshold | found | recall in % | AP50 | false alarms |\n| --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let whole: Vec<&Row> = sizes.iter().filter(|row| row["from"] == "48" && row["to"] == "300").collect();
    for row in &whole {
        let [recall, low, high] = ["recall", "low", "high"].map(|column| whole_percent(number(row, column)));
        writeln!(
            table,
            "| `{}` | {} | {:.2} | {} of {} | {recall} ({low} to {high}) | {} | {} |",
            row["detector"],
            row["pixels_of"],
            number(row, "threshold"),
            row["found"],
            row["cars"],
            row["ap50"],
            row["false_alarms"]
        )
        .unwrap();
    }
    page.table("recall", &table);
    let of = |detector: &str, pixels: &str| -> &Row {
        whole.iter().find(|row| row["detector"] == detector && row["pixels_of"] == pixels).unwrap()
    };
    let [centre, open] =
        ["centernet-coco", "ssd-open-images"].map(|name| whole_percent(number(of(name, "input"), "recall")));
    page.says(format!("find {centre} and {open} % of such cars"));
    let coco = of("ssd-coco", "input");
    assert!(number(coco, "recall") < 0.5);
    page.says(format!(
        "at its frozen threshold of {:.2}, but its AP50 is {:.1}",
        number(coco, "threshold"),
        number(coco, "ap50")
    ));
    for pixels in ["input", "image"] {
        let [ahead, other] = ["single-shot-ahead", "single-shot"].map(|name| number(of(name, pixels), "found"));
        assert!(2.0 * ahead < other, "the page says fewer than half as many");
    }
    page.given(&[
        "There are 500 images of five scenarios by day",
        "with 100 images of each",
        "They have 640 x 384 pixels, a focal length of 24 mm on a sensor of 36 mm",
    ]);
    page.given(&[
        "if at least 75 % of it is visible",
        "at 0.1 false alarms an image",
        "all scores from 0.05 on",
        "A car of 48 to 300 pixels in the **input**",
    ]);
    page.given(&["The rows for 48 to 300 pixels in the **image**", "is the interval of 95 % from resampled tests"]);
    page.close();
}

/// A share in whole percent; halves are rounded up, as in the file's three digits.
fn whole_percent(share: f64) -> String {
    format!("{}", (1000.0 * share / 10.0 + 1e-9).round())
}
