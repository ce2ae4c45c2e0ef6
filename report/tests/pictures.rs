//! Pictures of worlds and runs: that they show what there is, where it is, large enough.

use nalgebra::Vector2;
use paracosm_engine::object::{Body, Class};
use paracosm_engine::road::{Curve, Path, Roundabout, RoutePosition};
use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{
    AutonomousVehicle, Fixture, Mover, Pedestrian, Pose, Program, RoadSegment, Run, Scenario, Setup, Side, driver,
    never, watch,
};
use paracosm_oracles::Verdict;
use paracosm_report::birds_eye::{
    Anchor, Animation, Drawing, MotionRecord, PathSegment, PictureItem, RoadPicture, world,
};
use paracosm_space::Values;
use proptest::prelude::*;

const VERMILION: [u8; 3] = [0xd5, 0x5e, 0x00];

/// A long road with something of everything on it; the car drives up to another one.
fn busy(s: &mut Scenario) {
    let road = s.place(RoadSegment::new(800.0).lanes(6));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 30.0)).speed(15.0));
    s.place(Mover::car(road.path(1)).starting(60.0).speed(6.0));
    s.place(Mover::truck(road.path(2)).starting(50.0).speed(12.0));
    s.place(Mover::bicycle(road.path(3)).starting(90.0).speed(5.0));
    let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Right, 100.0)));
    walker.walk(road.on_sidewalk(Side::Right, 60.0), 1.5);
    let beside = |x: f64, y: f64| Pose { position: Vector2::new(x, y), heading: 0.0 };
    s.place(Fixture::tree(beside(40.0, -16.0)));
    s.place(Fixture::house(beside(70.0, -20.0)));
    s.place(Fixture::sign(beside(80.0, -14.0)));
    s.place(Fixture::new("box", Body::block(Class::Prop, 2.0, 1.0, 1.0), beside(50.0, -15.0)));
    s.duration(25.0);
    s.require("no-collision", never(car.collides()));
}

/// A car alone, far.
fn lonely(s: &mut Scenario) {
    let road = s.place(RoadSegment::new(2000.0));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(20.0));
    s.duration(60.0);
    s.require("no-collision", never(car.collides()));
}

/// Others that go around.
fn round(s: &mut Scenario) {
    let streets = s.place(
        Roundabout::new()
            .arms(4)
            .connect("one", RoadSegment::new(80.0).named("east"), "one")
            .connect("two", RoadSegment::new(80.0).named("north"), "one")
            .connect("three", RoadSegment::new(80.0).named("west"), "one")
            .connect("four", RoadSegment::new(80.0).named("south"), "one"),
    );
    let car = s.place(AutonomousVehicle::at(streets.on_lane("south", -1, 75.0)).speed(8.0));
    s.place(Mover::car(streets.way(("east", -1, 70.0), ("west", 1, 60.0))).speed(9.0));
    s.duration(25.0);
    s.require("no-collision", never(car.collides()));
}

fn program(build: fn(&mut Scenario)) -> Program {
    Program::new("test", "a test", build)
}

fn begun(build: fn(&mut Scenario)) -> Run {
    Run::new(&program(build), &Values::default(), Setup::asking_every(0.05)).unwrap()
}

/// What was seen of a run with this driver, and how it ended.
fn seen(build: fn(&mut Scenario), name: &str) -> (MotionRecord, Verdict) {
    let mut driver = driver::find(name).unwrap().build(&[]).unwrap();
    let mut record = MotionRecord::default();
    let outcome =
        watch(&program(build), &Values::default(), VehicleModel::SingleTrack, driver.as_mut(), |run| record.see(run));
    (record, outcome.verdict())
}

/// All marks, those of insets where they are on the whole picture.
fn marks(drawing: &Drawing) -> Vec<([f64; 2], &PictureItem)> {
    let mut all = Vec::new();
    for mark in &drawing.marks {
        match mark {
            PictureItem::Inset { at, drawing } => {
                all.extend(marks(drawing).into_iter().map(|([x, y], mark)| ([x + at[0], y + at[1]], mark)));
            }
            _ => all.push(([0.0, 0.0], mark)),
        }
    }
    all
}

/// The boxes (left, top, right, bottom) of what is filled with a colour.
fn boxes(drawing: &Drawing, colour: [u8; 3]) -> Vec<[f64; 4]> {
    let mut found = Vec::new();
    for ([x, y], mark) in marks(drawing) {
        let PictureItem::Fill { contour, paint } = mark else { continue };
        if paint.colour != colour {
            continue;
        }
        let mut bounds = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        for segment in &contour.segments {
            if let PathSegment::Move(to) | PathSegment::Line(to) | PathSegment::Cubic(_, _, to) = segment {
                let to = [to[0] + x, to[1] + y];
                bounds = [bounds[0].min(to[0]), bounds[1].min(to[1]), bounds[2].max(to[0]), bounds[3].max(to[1])];
            }
        }
        found.push(bounds);
    }
    found
}

fn texts(drawing: &Drawing) -> Vec<String> {
    let text = |(_, mark): &([f64; 2], &PictureItem)| match mark {
        PictureItem::Text { text, .. } => Some(text.clone()),
        _ => None,
    };
    marks(drawing).iter().filter_map(text).collect()
}

#[test]
fn a_world_shows_every_class_of_body_and_names_it() {
    let drawing = world(&begun(busy), "busy <&>");
    let texts = texts(&drawing);
    let names = ["ego vehicle", "car", "truck", "bicycle", "pedestrian", "building", "tree", "sign", "prop"];
    for name in names.into_iter().chain(["planned path", "busy <&>"]) {
        assert!(texts.iter().any(|text| text == name), "{name} is missing in {texts:?}");
    }
    let svg = drawing.svg();
    assert!(svg.contains("busy &lt;&amp;>") && !svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn a_car_on_a_long_road_is_no_dot() {
    let drawing = world(&begun(busy), "");
    // The car itself, then the arrow before it and the legend.
    let cars = boxes(&drawing, VERMILION);
    let car = cars.iter().find(|car| car[2] - car[0] > 25.0 && car[3] - car[1] < 15.0).expect("the car is seen");
    assert!(car[0] > 0.0 && car[2] < drawing.width, "{car:?} of {}", drawing.width);
    assert!(drawing.height < 0.5 * drawing.width, "a road is no square: {} high", drawing.height);
}

#[test]
fn a_plan_is_the_way_that_is_left() {
    let mut run = begun(busy);
    let all = |run: &Run| {
        run.plans()
            .into_iter()
            .map(|(body, path)| {
                let here = run.bodies()[body].pose.position;
                assert!((path.at(0.0).position - here).norm() < 1e-6, "body {body} is at {here:?}");
                (body, path.length())
            })
            .collect::<Vec<_>>()
    };
    let before = all(&run);
    assert_eq!(before.iter().map(|(body, _)| *body).collect::<Vec<_>>(), [1, 2, 3, 4]);
    assert!((before[0].1 - 740.0).abs() < 1e-9 && (before[3].1 - 40.0).abs() < 1e-9, "{before:?}");
    let mut driver = driver::find("aeb").unwrap().build(&[]).unwrap();
    run.drive(driver.as_mut());
    let after = all(&run);
    assert!((after[0].1 - (740.0 - 25.0 * 6.0)).abs() < 1e-6 && after[3].1 < 3.0, "{after:?}");
}

proptest! {
    #[test]
    fn a_piece_of_a_path_is_where_the_path_is(
        bends in prop::collection::vec((-0.05..0.05f64, 5.0..60.0f64), 1..5),
        shares in [-0.2..1.2f64, -0.2..1.2],
        along in 0.0..1.0f64,
    ) {
        let mut at = Pose { position: Vector2::new(3.0, -7.0), heading: 0.4 };
        let curves: Vec<Curve> = bends.iter().map(|(curvature, length)| {
            let curve = Curve::new(at, *curvature, *length);
            at = curve.end();
            curve
        }).collect();
        let path = Path::new(curves);
        let [a, b] = shares.map(|share| share * path.length());
        let piece = path.piece(a.min(b), a.max(b));
        let [from, to] = [a.min(b), a.max(b)].map(|s| s.clamp(0.0, path.length()));
        prop_assert!((piece.length() - (to - from)).abs() < 1e-9);
        let s = along * piece.length();
        prop_assert!((piece.at(s).position - path.at(from + s).position).norm() < 1e-7);
    }
}

#[test]
fn many_planned_ways_are_cut_short_so_that_roads_are_still_seen() {
    fn crowd(s: &mut Scenario) {
        let road = s.place(RoadSegment::new(900.0).lanes(6));
        let car = s.place(AutonomousVehicle::at(road.on_lane(2, 30.0)).speed(15.0));
        for i in 0..40 {
            s.place(Mover::car(road.path([-1, -2, 1][i % 3])).starting(20.0 * i as f64).speed(10.0));
        }
        s.require("no-collision", never(car.collides()));
    }
    let drawing = world(&begun(crowd), "");
    let scale = (drawing.width - 28.0) / 780.0;
    let dashed = |(_, mark): &([f64; 2], &PictureItem)| match mark {
        PictureItem::Stroke { contour, dash: Some(_), .. } => {
            let along = |segments: &[PathSegment]| match segments {
                [PathSegment::Move(a) | PathSegment::Line(a), PathSegment::Line(b)] => (b[0] - a[0]).abs(),
                _ => 0.0,
            };
            Some(contour.segments.windows(2).map(along).sum::<f64>() / scale)
        }
        _ => None,
    };
    let lengths: Vec<f64> = marks(&drawing).iter().filter_map(dashed).collect();
    assert!(lengths.len() > 40 && lengths.iter().all(|length| *length < 170.0), "{lengths:?}");
}

#[test]
fn a_run_tells_when_and_what_it_ended_at() {
    let mut run = begun(busy);
    let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
    let mut times = Vec::new();
    let mut ends = 0;
    let outcome = run.watch(driver.as_mut(), |run| {
        times.push(run.time());
        ends += usize::from(run.is_over());
    });
    let trace = outcome.trace.as_ref().unwrap();
    assert_eq!((outcome.verdict(), ends), (Verdict::Fail, 1));
    assert_eq!(run.touched(), Some(1), "the car drove into the one ahead");
    assert_eq!(run.time(), (trace.len() - 1) as f64 * paracosm_engine::DEFAULT_DT);
    assert_eq!((times[0], *times.last().unwrap()), (0.0, run.time()));
    assert!(times.windows(2).all(|two| two[0] < two[1]), "every moment is seen once");
}

#[test]
fn watching_a_run_changes_nothing() {
    let outcome = |watched: bool| {
        let mut driver = driver::find("aeb").unwrap().build(&[]).unwrap();
        let mut record = MotionRecord::default();
        let outcome = watch(&program(busy), &Values::default(), VehicleModel::SingleTrack, driver.as_mut(), |run| {
            if watched {
                record.see(run);
            }
        });
        assert_eq!(record.is_empty(), !watched);
        outcome.trace.unwrap().hash()
    };
    assert_eq!(outcome(true), outcome(false));
}

#[test]
fn a_story_marks_the_contact_and_its_time() {
    let (record, verdict) = seen(busy, "cruise");
    assert_eq!(verdict, Verdict::Fail);
    let drawing = record.story("").unwrap();
    let texts = texts(&drawing);
    assert!(texts.iter().any(|text| text.starts_with("contact, ") && text.ends_with(" s")), "{texts:?}");
    assert!(texts.iter().any(|text| text == "contact"), "the legend says what the star is");
    let (record, verdict) = seen(busy, "aeb");
    assert_eq!(verdict, Verdict::Pass);
    assert!(!self::texts(&record.story("").unwrap()).iter().any(|text| text.contains("contact")));
}

/// The boxes that the time labels take at least, with letters of half the width that is reckoned with.
fn labels(drawing: &Drawing) -> Vec<[f64; 4]> {
    let label = |([x, y], mark): ([f64; 2], &PictureItem)| match mark {
        PictureItem::Text { at, anchor: Anchor::Middle, size, text, .. } => {
            let half = 0.25 * size * text.chars().count() as f64;
            let (x, y) = (x + at[0], y + at[1]);
            Some([x - half, y - 0.7 * size, x + half, y])
        }
        _ => None,
    };
    marks(drawing).into_iter().filter_map(label).collect()
}

#[test]
fn labels_keep_out_of_each_others_way_and_on_the_picture() {
    for build in [busy as fn(&mut Scenario), round, lonely] {
        for driver in ["aeb", "cruise"] {
            let drawing = seen(build, driver).0.story("").unwrap();
            let labels = labels(&drawing);
            assert!(labels.len() >= 4, "{} labels", labels.len());
            for (i, a) in labels.iter().enumerate() {
                assert!(a[0] >= 0.0 && a[1] >= 0.0 && a[2] <= drawing.width && a[3] <= drawing.height, "{a:?}");
                for b in &labels[..i] {
                    let apart = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
                    assert!(apart, "{a:?} and {b:?} overlap");
                }
            }
        }
    }
}

#[test]
fn a_story_that_is_too_long_for_one_view_has_several_of_one_size() {
    let insets = |build| {
        let drawing = seen(build, "aeb").0.story("").unwrap();
        let size = |mark: &PictureItem| match mark {
            PictureItem::Inset { drawing, .. } => Some((drawing.width, drawing.height)),
            _ => None,
        };
        drawing.marks.iter().filter_map(size).collect::<Vec<_>>()
    };
    // The last one is the legend.
    let pages = insets(lonely);
    assert!((4..=7).contains(&pages.len()), "{pages:?}");
    assert!(pages[..pages.len() - 1].iter().all(|page| *page == pages[0]), "{pages:?}");
    assert_eq!(insets(round).len(), 2);
}

/// Where the ego vehicle is on each frame.
fn cars(film: &Animation) -> Vec<[f64; 4]> {
    let car = |frame: &paracosm_report::birds_eye::Frame| boxes(&frame.drawing, VERMILION).last().copied();
    film.frames.iter().filter_map(car).collect()
}

#[test]
fn a_film_has_a_frame_for_every_tenth_of_a_second_and_ends_where_the_run_does() {
    let (record, _) = seen(busy, "cruise");
    let film = record.film(800.0, "").unwrap();
    let times: Vec<f64> = film.frames.iter().map(|frame| frame.time).collect();
    assert_eq!(times[0], 0.0);
    let end = times[times.len() - 1];
    assert!((2.0..10.0).contains(&end), "{end}");
    assert!((times.len() as f64 - 10.0 * end).abs() <= 2.0, "{} frames in {end} s", times.len());
    assert!(texts(&film.frames[times.len() - 1].drawing)[0].starts_with("contact, "));
}

#[test]
fn a_film_never_loses_the_car_under_test_and_has_not_too_many_frames() {
    for build in [busy as fn(&mut Scenario), lonely, round] {
        let film = seen(build, "aeb").0.film(800.0, "").unwrap();
        assert!((80..=312).contains(&film.frames.len()), "{} frames", film.frames.len());
        let (width, height) = (film.scenes[0].width, film.scenes[0].height);
        assert!(film.scenes.iter().all(|scene| (scene.width, scene.height) == (width, height)));
        assert_eq!(width, 800.0);
        let cars = cars(&film);
        assert_eq!(cars.len(), film.frames.len(), "the car is on every frame");
        for car in cars {
            assert!(car[0] > 0.0 && car[1] > 0.0 && car[2] < width && car[3] < height, "{car:?}");
        }
    }
}

#[test]
fn nothing_is_drawn_of_a_run_that_nobody_saw() {
    assert_eq!(MotionRecord::default().story(""), None);
    assert_eq!(MotionRecord::default().film(800.0, ""), None);
}

#[test]
fn a_picture_shows_every_surface_and_what_is_laid_over_it() {
    let net = RoadSegment::new(60.0)
        .zebra(30.0)
        .connect("two", Roundabout::new().lanes(2), "three")
        .connect("roundabout.one", RoadSegment::new(30.0).sidewalk(0.0), "one")
        .build()
        .unwrap();
    let plain = RoadPicture::of(&net).svg();
    assert!(plain.starts_with("<svg") && plain.ends_with("</svg>\n") && !plain.contains("NaN"));
    let surfaces = net.strips().iter().map(|strip| strip.surface).collect::<std::collections::HashSet<_>>();
    let ground = 1;
    assert_eq!(plain.matches("<path fill=\"#").count(), ground + surfaces.len());
    let route = net.route(
        RoutePosition { lane: net.lane_of("road", 1).unwrap(), s: 0.0 },
        RoutePosition { lane: net.lane_of("road-2", 1).unwrap(), s: 10.0 },
        20.0,
    );
    let car = net.on_lane("road", 1, 10.0).unwrap();
    let full = RoadPicture::of(&net).route(&route.unwrap(), [1, 2, 3]).body(car, 4.5, 1.8, [0xcc, 0x33, 0x11]).svg();
    assert!(full.contains("#010203") && full.contains("#cc3311"));
}

#[test]
fn a_road_of_many_kilometres_is_seen() {
    let net = RoadSegment::new(90_000.0).build().unwrap();
    // The carriageway of one pixel, besides the ground and the scale bar.
    assert!(RoadPicture::of(&net).svg().contains("#5b5f66"));
}

#[test]
fn a_thing_is_drawn_in_the_colour_of_its_class() {
    let net = RoadSegment::new(100.0).build().unwrap();
    let at = Pose { position: Vector2::new(50.0, 8.0), heading: 0.0 };
    let tree = Body::disc(Class::Tree, 0.3, 6.0);
    let [without, with] = [RoadPicture::of(&net), RoadPicture::of(&net).thing(tree, at)].map(|picture| picture.svg());
    assert!(!without.contains("#009e73") && with.contains("#009e73"), "{with}");
}
