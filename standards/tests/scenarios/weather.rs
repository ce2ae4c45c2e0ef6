//! The weather of scenarios: the light, the fog, the rain, the sun and the friction of the road that worlds get.

use super::bad::changed_in;
use super::worlds::file;
use paracosm_engine::{Control, Program, Run, Setup, Step, Weather};
use paracosm_standards::openscenario::Xosc;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

fn program(file: &Path) -> Program {
    Xosc::read(file).unwrap_or_else(|error| panic!("{error}")).program()
}

/// Returns the weather of a program every second, with nominal values.
fn weathers(program: &Program) -> Vec<Weather> {
    let setup = Setup { takes_over: false, ..Setup::asking_every(1.0) };
    let mut run = Run::new(program, &program.declare().unwrap().nominal(), setup).unwrap();
    let mut all = Vec::new();
    while let Step::Need(_) = run.advance() {
        all.push(run.weather());
        run.supply(Control::default());
    }
    all
}

/// Returns the weather at the beginning of `weather.xosc` in which a text is replaced by another text, and the remarks.
fn changed(found: &str, by: &str) -> (Weather, Vec<String>) {
    let (_folder, path) = changed_in("weather.xosc", found, by);
    let program = program(&path);
    (weathers(&program)[0], program.notes(&program.declare().unwrap().nominal()))
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-4, "{found} instead of {expected}");
}

#[test]
fn an_environment_gives_the_world_its_weather_and_changes_it_in_the_story() {
    let all = weathers(&program(&file("weather.xosc")));
    let Weather { light, fog, rain, sun_elevation, sun_azimuth } = all[1];
    // It is noon at the equinox, 50 degrees north.
    let [up, aside] = [40.0_f64.to_radians(), -FRAC_PI_2];
    for (found, expected) in [(light, 1.0), (fog, 0.5), (rain, 0.1)] {
        near(found, expected);
    }
    assert!((sun_elevation - up).abs() < 0.01 && (sun_azimuth - aside).abs() < 0.01, "{:?}", all[1]);
    assert!(all[1].sun_azimuth < all[0].sun_azimuth, "the sun moves to the west: {all:?}");
    let Weather { light, fog, rain, sun_elevation, sun_azimuth } = all[3];
    for (found, expected) in [(light, 0.2), (rain, 0.0), (sun_elevation, 0.3), (sun_azimuth, 0.0)] {
        near(found, expected);
    }
    assert!(fog < 0.02, "{fog}");
}

#[test]
fn the_friction_of_the_road_lengthens_the_way_in_which_a_car_stops() {
    let with = |friction: &str| {
        let value = "name=\"friction\" parameterType=\"double\" value=\"0.5\"";
        let (_folder, path) = changed_in("weather.xosc", value, &value.replace("0.5", friction));
        let program = program(&path);
        let mut run = Run::new(&program, &program.declare().unwrap().nominal(), Setup::asking_every(0.1)).unwrap();
        loop {
            match run.advance() {
                Step::Need(_) => run.supply(Control { throttle: -1.0, steering: 0.0 }),
                Step::Done(outcome) => break outcome.measured.unwrap().travelled,
            }
        }
    };
    // From 10 m/s with the friction 0.8 times the factor, of which 5 mm/h of rain take 3 % for 2 s.
    for (factor, friction) in [("0.5", 0.39), ("0.4", 0.315)] {
        let (found, expected) = (with(factor), 10.0 * 10.0 / (2.0 * 9.81 * friction));
        assert!((found - expected).abs() < 0.1 * expected, "{found} m instead of {expected} m");
    }
}

#[test]
fn a_scenario_without_weather_keeps_the_usual_weather() {
    let usual = Weather::default();
    assert!(weathers(&program(&file("slow-leader.xosc"))).iter().all(|weather| *weather == usual));
}

#[test]
fn values_that_the_world_cannot_have_are_noted() {
    let rain = "precipitationType=\"rain\" precipitationIntensity=\"5\"";
    let fog = "name=\"visibility\" parameterType=\"double\" value=\"326.23\"";
    for (found, by, expected, says) in [
        (rain, "precipitationType=\"snow\" precipitationIntensity=\"5\"".to_owned(), (0.5, 0.0), "there is no snow"),
        (rain, rain.replace('5', "80"), (0.5, 1.0), "it rains 50 mm/h"),
        (fog, fog.replace("326.23", "4"), (1.0, 0.1), "the visibility is 10 m"),
    ] {
        let (weather, notes) = changed(found, &by);
        near(weather.fog, expected.0);
        near(weather.rain, expected.1);
        assert!(notes.iter().any(|note| note.contains(says)), "{notes:?}");
    }
    let (_, notes) = changed(rain, rain);
    for name in ["fractionalCloudCover", "cloudState", "atmosphericPressure", "temperature", "wetness"] {
        assert!(notes.iter().any(|note| note.contains(name)), "{name}: {notes:?}");
    }
    for name in ["`Wind`", "`DomeImage`", "`BoundingBox`", "`Properties`"] {
        assert!(notes.iter().any(|note| note.contains(name)), "{name}: {notes:?}");
    }
}

#[test]
fn files_of_version_1_0_have_shares_of_rain_and_of_light() {
    let rain = "precipitationType=\"rain\" precipitationIntensity=\"5\"";
    near(changed(rain, "precipitationType=\"rain\" intensity=\"0.4\"").0.rain, 0.4);
    let sun = |intensity: &str| {
        let sun = format!("<Sun elevation=\"0.5\" azimuth=\"{PI}\" intensity=\"{intensity}\"/><Fog visualRange");
        changed("<Fog visualRange", &sun).0
    };
    for (intensity, light) in [("0.7", 0.7), ("30000", 0.3), ("200000", 1.0)] {
        let weather = sun(intensity);
        near(weather.light, light);
        near(weather.sun_elevation, 0.5);
        near(weather.sun_azimuth, -FRAC_PI_2);
    }
}

#[test]
fn a_mistake_in_the_weather_is_refused_with_its_line() {
    for (found, by, says) in [
        ("visualRange=\"$visibility\"", "visualRange=\"-1\"", "`visualRange=\"-1\"` of <Fog>"),
        ("elevation=\"0.3\"", "elevation=\"30\"", "`elevation=\"30\"` of <Sun>"),
        ("frictionScaleFactor=\"$friction\"", "frictionScaleFactor=\"slippery\"", "of <RoadCondition>"),
        ("precipitationIntensity=\"5\"", "intensity=\"5\"", "expected a number from 0 to 1"),
        (" precipitationIntensity=\"5\"", "", "<Precipitation> has no attribute `precipitationIntensity`"),
        ("precipitationType=\"rain\"", "precipitationType=\"rian\"", "did you mean `rain`?"),
    ] {
        let (_folder, path) = changed_in("weather.xosc", found, by);
        let error = Xosc::read(&path).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains("bad.xosc:") && error.contains(says), "{error} instead of {says}");
    }
}
