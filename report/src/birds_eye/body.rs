//! Bodies from above. Each class has its own shape and colour.
//!
//! The colours are those of Okabe and Ito ("Color Universal Design", 2008), which people with any kind of colour vision
//! can tell apart. No meaning is shown by colour alone.

use super::drawing::{Colour, Contour, Paint, PictureItem};
use super::ground::seen_from;
use super::view::View;
use paracosm_engine::Pose;
use paracosm_engine::object::{Body, Class, Outline};

/// The colour of the ego vehicle.
pub(super) const UNDER_TEST: Colour = [0xd5, 0x5e, 0x00];
const RIM: Colour = [0xff, 0xff, 0xff];
const WINDOW: Paint = Paint { colour: [0xff, 0xff, 0xff], opacity: 0.6 };
/// The least radius in pixels of small round bodies, which could otherwise hardly be seen.
const LEAST_RADIUS: f64 = 3.5;
/// The least width in pixels of a vehicle.
const LEAST_WIDTH: f64 = 5.0;
/// The radius of a tree's crown, as a share of the tree's height.
const CROWN: f64 = 0.25;

/// Returns `true` if bodies of this class move about. Pictures show the ground around them.
pub(super) fn is_actor(class: Class) -> bool {
    class.is_road_user()
}

/// Returns the colour of a class of bodies.
pub(super) fn class_colour(class: Class) -> Colour {
    match class {
        Class::Car => [0x56, 0xb4, 0xe9],
        Class::Van | Class::Truck | Class::Bus => [0x00, 0x72, 0xb2],
        Class::Motorcycle | Class::Bicycle => [0xf0, 0xe4, 0x42],
        Class::Pedestrian => [0xcc, 0x79, 0xa7],
        Class::Building => [0xc2, 0xae, 0x90],
        Class::Tree => [0x00, 0x9e, 0x73],
        Class::Sign => [0xf0, 0xf0, 0xf0],
        Class::Prop => [0x9a, 0x9a, 0x9a],
    }
}

/// Returns a distance in metres from the body's middle beyond which nothing of the body is drawn.
pub(super) fn extent(body: &Body) -> f64 {
    body.outline.reach().max(CROWN * body.height)
}

/// Draws a body in this colour, if the view shows it. `share` is the opacity: below 1 for a ghost of the body.
pub(super) fn body(view: &View, body: &Body, pose: &Pose, colour: Colour, share: f64) -> Vec<PictureItem> {
    if !view.shows(pose.position, extent(body)) {
        return Vec::new();
    }
    let centre = view.at(pose.position);
    let rim = |contour: &Contour, width: f64| contour.clone().stroke(Paint::from(RIM).faint(share), width);
    let fill = |contour: Contour, paint: Paint| contour.fill(paint.faint(share));
    let half = body.outline.half_extent();
    let solid = Paint::from(colour);
    match (body.class, body.outline) {
        (Class::Tree, _) => {
            let radius = (CROWN * body.height).max(half.x) * view.scale;
            let crown = Contour::star(centre, 9, radius.max(LEAST_RADIUS), 0.8 * radius.max(LEAST_RADIUS));
            let trunk = Contour::circle(centre, (half.x * view.scale).max(1.5));
            vec![fill(crown, solid.faint(0.75)), fill(trunk, [0x5a, 0x46, 0x32].into())]
        }
        (_, Outline::Disc { radius }) => {
            let disc = Contour::circle(centre, (radius * view.scale).max(LEAST_RADIUS));
            let ring = if body.class == Class::Sign { [0x33, 0x33, 0x33] } else { RIM };
            vec![disc.clone().stroke(Paint::from(ring).faint(share), 2.0), fill(disc, solid)]
        }
        (class, Outline::Rectangle { .. }) => {
            let wide = (0.5 * LEAST_WIDTH / view.scale / half.y).max(1.0);
            let (l, w) = (half.x * wide, half.y * wide);
            let block = |from: f64, to: f64, side: f64| {
                let corners = [(from, side), (to, side), (to, -side), (from, -side)];
                Contour::polygon(corners.map(|(x, y)| view.at(seen_from(pose, x * l, y * w))))
            };
            match class {
                Class::Car | Class::Van => {
                    let hull = hull(view, pose, l, w);
                    vec![rim(&hull, 1.5), fill(hull, solid), fill(block(0.1, 0.42, 0.76), WINDOW)]
                }
                // The load, and the cab in front of the load.
                Class::Truck => {
                    let (load, cab) = (block(-1.0, 0.55, 1.0), block(0.62, 1.0, 0.94));
                    let window = fill(block(0.78, 0.9, 0.8), WINDOW);
                    vec![rim(&load, 1.5), rim(&cab, 1.5), fill(load, solid), fill(cab, solid), window]
                }
                // A frame, and the rider's shoulders across it.
                Class::Motorcycle | Class::Bicycle => {
                    let (frame, rider) = (block(-1.0, 1.0, 0.3), hull(view, &turned(pose), w, 0.35 * w));
                    vec![rim(&frame, 1.5), rim(&rider, 1.5), fill(frame, solid), fill(rider, solid)]
                }
                // A roof with its ridge.
                Class::Building => {
                    let [from, to] = [-1.0, 1.0].map(|x| view.at(seen_from(pose, x * l, 0.0)));
                    let edge = Paint::from([0x8a, 0x78, 0x5c]).faint(share);
                    let roof = block(-1.0, 1.0, 1.0);
                    let ridge = Contour::polyline([from, to]).stroke(edge, 1.2);
                    vec![fill(roof.clone(), solid), roof.stroke(edge, 1.2), ridge]
                }
                _ => {
                    let block = block(-1.0, 1.0, 1.0);
                    vec![rim(&block, 1.5), fill(block, solid)]
                }
            }
        }
    }
}

/// Returns a rectangle with cut corners, longer in front, that is the outline of a vehicle. `l` and `w` are half its
/// length and half its width.
fn hull(view: &View, pose: &Pose, l: f64, w: f64) -> Contour {
    let right = [(-l, -0.6 * w), (-0.85 * l, -w), (0.7 * l, -w), (l, -0.55 * w)];
    let left = right.iter().rev().map(|(x, y)| (*x, -y));
    Contour::polygon(right.into_iter().chain(left).map(|(x, y)| view.at(seen_from(pose, x, y))))
}

fn turned(pose: &Pose) -> Pose {
    Pose { heading: pose.heading + std::f64::consts::FRAC_PI_2, ..*pose }
}
