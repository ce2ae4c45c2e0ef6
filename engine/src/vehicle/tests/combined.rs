//! Combined slip against the published tyre of the same car, and the table of `docs/vehicles.md`.

use super::super::tyre::Tyre;
use super::*;
use std::fmt::Write;

/// The friction of the source's tyre to the side.
const FRICTION: f64 = 1.0489;
/// The slip angles of the table in degrees, and the braking forces as shares of the greatest force.
const ANGLES: [f64; 5] = [1.0, 2.0, 4.0, 6.0, 8.0];
const SHARES: [f64; 5] = [0.0, 0.4, 0.6, 0.8, 0.9];
const LOAD: f64 = 4000.0;

/// Magic Formula with the coefficients B, C and E, without its peak: the angle whose sine or cosine is the share.
fn magic(slip: f64, [b, c, e]: [f64; 3]) -> f64 {
    let stiff = b * slip;
    c * libm::atan(stiff - e * (stiff - libm::atan(stiff)))
}

/// The forces along and across of the tyre in the CommonRoad vehicle models (Althoff and Würsching, "CommonRoad: Vehicle
/// Models", 2020, table 7; the tyre is that of the ADAMS handbook), each as a share of its own peak, at a slip ratio of
/// brakes and a slip angle. The shifts, which stand for a tyre with two unequal sides, are left out.
fn published(ratio: f64, angle: f64) -> Vector2<f64> {
    let along = libm::sin(magic(ratio, [22.303 / (1.6411 * 1.1739), 1.6411, 0.46403]));
    let across = libm::sin(magic(angle, [21.92 / (1.3507 * 1.0489), 1.3507, -0.0074722]));
    let narrowed = |by: f64, slip: f64| libm::cos(libm::atan(by * slip));
    let along = along * libm::cos(magic(angle, [13.276 * narrowed(-13.778, ratio), 1.2568, 0.65225]));
    let across = across * libm::cos(magic(ratio, [7.1433 * narrowed(9.1916, angle), 1.0719, -0.27572]));
    Vector2::new(along, across)
}

/// The forces of the published tyre that brakes with a share of its peak; with the nearest smaller share if it cannot.
fn published_at(share: f64, angle: f64) -> Vector2<f64> {
    let forces = (0..=10_000).map(|i| published(1e-4 * f64::from(i), angle));
    let mut best = Vector2::new(-1.0, 0.0);
    for force in forces {
        if force.x > best.x {
            best = force;
        }
        if force.x >= share {
            break;
        }
    }
    best
}

/// The forces of the brush model as shares of its greatest force.
fn brush(share: f64, angle: f64) -> Vector2<f64> {
    let tyre = Tyre::new(CAR.cornering_stiffness, FRICTION, LOAD);
    let force = tyre.combined(-share * tyre.limit, libm::tan(angle)).0 / tyre.limit;
    force.abs()
}

/// The forces of the single-track model, which cuts the demanded forces to the friction circle, as shares of the
/// greatest force.
fn cut(share: f64, angle: f64) -> Vector2<f64> {
    let tyre = Tyre::new(CAR.cornering_stiffness, FRICTION, LOAD);
    let side = tyre.side_force(libm::tan(angle)).0;
    tyre.cut(Vector2::new(share * tyre.limit, side)) / tyre.limit
}

/// The greatest distances between the forces of a model and the published tyre over the table: along and across.
fn apart(model: fn(f64, f64) -> Vector2<f64>) -> Vector2<f64> {
    let cells = ANGLES.into_iter().flat_map(|angle| SHARES.map(|share| (share, angle.to_radians())));
    cells.fold(Vector2::zeros(), |most: Vector2<f64>, (share, angle)| {
        most.sup(&(model(share, angle) - published_at(share, angle)).abs())
    })
}

#[test]
fn a_cut_of_the_demands_is_as_far_from_the_published_tyre_as_the_document_says() {
    let (brush, cut) = (apart(brush), apart(cut));
    assert!((brush.x - 0.082).abs() < 1e-3 && (cut.x - 0.188).abs() < 1e-3, "along: {} and {}", brush.x, cut.x);
    assert!((brush.y - 0.159).abs() < 1e-3 && (cut.y - 0.265).abs() < 1e-3, "across: {} and {}", brush.y, cut.y);
}

fn table() -> String {
    let mut text = String::from(
        "| slip angle | brakes ask for | this car | brush with combined slip | published tyre |\n| --- | --- | --- | --- | --- |\n",
    );
    for angle in ANGLES {
        for share in SHARES {
            let cells = [cut, brush, published_at].map(|model| {
                let force = model(share, angle.to_radians());
                format!("{:.2}, {:.2}", force.x, force.y)
            });
            writeln!(text, "| {angle}° | {share} | {} |", cells.join(" | ")).unwrap();
        }
    }
    text
}

#[test]
fn the_table_of_the_document_is_the_one_that_the_models_give() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/vehicles.md");
    let text = std::fs::read_to_string(page).unwrap();
    let [begin, end] = ["<!-- combined slip -->\n", "<!-- end -->"].map(|mark| text.find(mark).unwrap());
    let begin = begin + "<!-- combined slip -->\n".len();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(page, format!("{}{}{}", &text[..begin], table(), &text[end..])).unwrap();
    } else {
        assert!(text[begin..end] == table(), "UPDATE_GOLDEN=1 writes the table of docs/vehicles.md anew");
    }
}
