//! Tests of the measures on cases that can be computed by hand, and of the encounters.

use crate::*;
use proptest::prelude::*;

fn rect(left: f64, top: f64, width: f64, height: f64) -> Rect {
    Rect { left, top, width, height }
}

fn seen(score: f64, rect: Rect) -> Detection {
    Detection { class: 0, score, rect }
}

fn object(rect: Rect) -> Object {
    Object { rect, area: rect.area(), crowd: false }
}

#[test]
fn half_of_two_equal_boxes_overlaps_by_a_third() {
    let (a, b) = (rect(0.0, 0.0, 4.0, 4.0), rect(2.0, 0.0, 4.0, 4.0));
    assert_eq!((a.overlap(&b), a.share_in(&b), a.overlap(&rect(4.0, 0.0, 1.0, 1.0))), (1.0 / 3.0, 0.5, 0.0));
    assert_eq!(a.within(3.0, 2.0), Some(rect(0.0, 0.0, 3.0, 2.0)));
    assert_eq!(rect(-9.0, 0.0, 4.0, 4.0).within(3.0, 2.0), None);
}

#[test]
fn the_weaker_of_two_boxes_of_one_class_on_one_object_is_dropped() {
    let near = rect(1.0, 0.0, 10.0, 10.0);
    let found = [seen(0.6, near), seen(0.9, rect(0.0, 0.0, 10.0, 10.0)), Detection { class: 1, ..seen(0.7, near) }];
    let kept: Vec<f64> = suppress(&found, 0.5, 0.5).iter().map(|one| one.score).collect();
    assert_eq!(kept, [0.9, 0.7]);
    assert_eq!(suppress(&found, 0.5, 1.0).len(), 3);
    assert_eq!(suppress(&found, 0.65, 1.0).len(), 2);
}

#[test]
fn the_best_detection_chooses_first_and_a_crowd_only_takes_what_nothing_else_takes() {
    let objects = [object(rect(0.0, 0.0, 10.0, 10.0)), Object { crowd: true, ..object(rect(0.0, 0.0, 40.0, 40.0)) }];
    let detections = [
        seen(0.5, rect(0.0, 0.0, 10.0, 10.0)),
        seen(0.9, rect(1.0, 0.0, 10.0, 10.0)),
        seen(0.4, rect(60.0, 0.0, 9.0, 9.0)),
    ];
    let matching = match_boxes(&objects, &detections, Criterion::Overlap(0.5), Areas::ALL);
    assert_eq!(matching.detections, [1, 0, 2]);
    assert_eq!(matching.objects, [Some(0), Some(1), None]);
    assert_eq!(matching.detected[0], Some(1));
}

#[test]
fn centres_match_within_a_share_of_the_diagonal() {
    let objects = [object(rect(0.0, 0.0, 30.0, 40.0))];
    let at = |x: f64| [seen(0.9, rect(x, 0.0, 30.0, 40.0))];
    let matched = |x: f64| match_boxes(&objects, &at(x), Criterion::Centres(0.2), Areas::ALL).detected[0].is_some();
    assert_eq!((matched(9.9), matched(10.1)), (true, false));
}

#[test]
fn a_false_alarm_before_the_only_match_halves_the_average_precision() {
    let objects = [object(rect(0.0, 0.0, 10.0, 10.0))];
    let detections = [seen(0.9, rect(50.0, 0.0, 10.0, 10.0)), seen(0.8, rect(0.0, 0.0, 10.0, 10.0))];
    let mut tally = Tally::default();
    tally.add(&objects, &detections, Criterion::Overlap(0.5), Areas::ALL);
    assert_eq!((tally.objects(), tally.matches(), tally.false_alarms()), (1, 1, 1));
    assert!((tally.average_precision().unwrap() - 0.5).abs() < 1e-12);
    assert_eq!(tally.recall(), Some(1.0));
    assert_eq!(Tally::default().average_precision(), None);
}

#[test]
fn a_mask_without_pixels_is_right_about_nothing_at_all() {
    let mask = |pixels: [bool; 4]| Mask { width: 2, height: 2, pixels: pixels.to_vec() };
    let (none, half, other) = (mask([false; 4]), mask([true, true, false, false]), mask([true, false, true, false]));
    let counts = Confusion::of(&half, &other);
    assert_eq!((counts.overlap(), counts.precision(), counts.recall()), (1.0 / 3.0, 0.5, 0.5));
    assert_eq!(Confusion::of(&none, &none).overlap(), 1.0);
    assert_eq!((Confusion::of(&none, &half).recall(), Confusion::of(&none, &half).precision()), (0.0, 1.0));
}

#[test]
fn an_encounter_waits_from_its_first_image_without_a_match() {
    let mut encounters = Encounters::default();
    encounters.see(0.0, [(7, false)]);
    encounters.see(0.1, [(7, false), (9, true)]);
    assert!((encounters.unmatched(0.1) - 0.1).abs() < 1e-12);
    encounters.see(0.2, [(7, true), (9, false)]);
    assert_eq!(encounters.unmatched(0.2), 0.0);
    assert!((encounters.unmatched(0.5) - 0.3).abs() < 1e-12);
    encounters.see(0.3, [(9, false)]);
    encounters.see(0.4, [(7, false)]);
    let of = |object: u16| encounters.all().iter().filter(|one| one.object == object).collect::<Vec<_>>();
    // Object 7 went out of sight and came back: these are two encounters.
    assert_eq!(of(7).len(), 2);
    assert_eq!((of(7)[0].delay(), of(7)[1].delay(), of(9)[0].delay()), (Some(0.2), None, Some(0.0)));
}

#[test]
fn usual_groups_merge_vehicles_and_let_riders_be_people() {
    let classes = ["person", "Car", "truck", "bus", "dog"].map(str::to_owned).to_vec();
    let detector = Detector::of(classes);
    assert_eq!(detector.groups_of_classes(), [Some(1), Some(0), Some(0), Some(0), None]);
    assert_eq!(detector.groups[1].may_be, ["motorcycle", "bicycle"]);
    assert_eq!(detector.check(), Ok(()));
}

#[test]
fn descriptions_that_contradict_themselves_are_refused_by_name() {
    let message = |detector: Detector| detector.check().unwrap_err().to_string();
    let of = |classes: &[&str]| Detector::of(classes.iter().map(|class| (*class).to_owned()).collect());
    assert!(message(of(&[])).contains("`classes` is empty"));
    assert!(message(of(&["dog", "cat"])).contains("the classes are dog, cat"));
    assert!(message(Detector { threshold: 1.5, ..of(&["car"]) }).contains("`threshold` is 1.5"));
    let mut wrong = of(&["car"]);
    wrong.groups[0].is = vec!["truk".to_owned()];
    assert!(message(wrong).contains("did you mean `truck`?"));
    let mut twice = of(&["car", "truck"]);
    twice.groups.push(Group { name: "lorry".to_owned(), ..twice.groups[0].clone() });
    assert!(message(twice).contains("belongs to the groups `vehicle` and `lorry`"));
}

/// The average precision by its definition: for each of the 101 recalls, the greatest precision of all thresholds that
/// reach the recall.
fn by_definition(scored: &[(f64, bool)], objects: usize) -> f64 {
    let at = |threshold: f64| {
        let kept: Vec<bool> = scored.iter().filter(|(score, _)| *score >= threshold).map(|(_, hit)| *hit).collect();
        let hits = kept.iter().filter(|hit| **hit).count() as f64;
        (hits / objects as f64, hits / kept.len() as f64)
    };
    let points: Vec<(f64, f64)> = scored.iter().map(|(score, _)| at(*score)).collect();
    let best =
        |recall: f64| points.iter().filter(|(reached, _)| *reached >= recall).map(|(_, p)| *p).fold(0.0, f64::max);
    // As in numpy, 0.95 is 95 times 0.01, which is a little more.
    (0..=100).map(|step| best(f64::from(step) * 0.01)).sum::<f64>() / 101.0
}

proptest! {
    #[test]
    fn average_precision_is_that_of_its_definition(hits in prop::collection::vec(any::<bool>(), 0..40), missed in 0usize..6) {
        // Detections of different scores, each on an object of its own or on none.
        let objects: Vec<Object> = (0..hits.len() + missed).map(|i| object(rect(20.0 * i as f64, 0.0, 10.0, 10.0))).collect();
        let there: Vec<Object> = objects.iter().zip(hits.iter().chain(std::iter::repeat(&true)))
            .filter(|(_, is_there)| **is_there).map(|(object, _)| *object).collect();
        prop_assume!(!there.is_empty());
        let scored: Vec<(f64, bool)> =
            hits.iter().enumerate().map(|(i, hit)| (1.0 - i as f64 / 100.0, *hit)).collect();
        let detections: Vec<Detection> =
            scored.iter().zip(&objects).map(|((score, _), object)| seen(*score, object.rect)).collect();
        let mut tally = Tally::default();
        tally.add(&there, &detections, Criterion::Overlap(0.5), Areas::ALL);
        let found = tally.average_precision().unwrap();
        prop_assert!((found - by_definition(&scored, there.len())).abs() < 1e-9);
    }
}
