//! The ground truth of an image: the road users in it, with their boxes, their visible shares and their distances.
//!
//! The parked cars of the look `textured` are in it, too. They exist only in pictures, so that nobody has to detect them.

use paracosm_engine::object::Class;
use paracosm_engine::sensor::Moment;
use paracosm_perception::{Extent, Mask, Rect};
use paracosm_render::{Box2, Box3, Camera, Rendering, Semantic, boxes, is_only_pictured};

/// The id of the ego vehicle in images. The ids of the other bodies follow in the order of the bodies.
const OWN: u16 = 1;
/// A road user with at least this visible share and at most this distance in metres should be detected.
const VISIBLE: f64 = 0.75;
const NEAR: f64 = 40.0;

/// A road user in an image.
#[derive(Debug, Clone, PartialEq)]
pub struct RoadUser {
    /// The id of the body in the images of a test.
    pub id: u16,
    /// The name of the class.
    pub kind: String,
    /// The box around the visible part or the whole object.
    pub rect: Rect,
    /// The number of visible pixels.
    pub pixels: u32,
    /// The share of the object that is in the image and not behind another object, from 0 to 1.
    pub visible: f64,
    /// The distance in metres from the middle of the ego vehicle to the middle of the road user; infinite for a car that
    /// exists only in pictures.
    pub distance: f64,
}

impl RoadUser {
    /// Returns `true` if a detector should detect the road user: at least 75 % of it is visible, and it is at most 40 m
    /// away.
    pub fn should_be_detected(&self) -> bool {
        self.visible >= VISIBLE && self.distance <= NEAR
    }
}

/// Returns the road users in an image, sorted by id.
pub(crate) fn road_users(picture: &Rendering, moment: &Moment, camera: &Camera, extent: Extent) -> Vec<RoadUser> {
    let car = moment.bodies[0].pose.position;
    let user = |seen: Box2| {
        let id = seen.visible.id;
        let (class, distance) = if is_only_pictured(id) {
            (Class::Car, f64::INFINITY)
        } else {
            let state = moment.bodies.get(usize::from(id).checked_sub(1)?)?;
            (state.body.class, (state.pose.position - car).norm())
        };
        if id == OWN || !class.is_road_user() {
            return None;
        }
        let alone = picture.frame.alone.iter().flatten().find(|alone| alone.id == id);
        let of_pixels =
            |min: [u32; 2], max: [u32; 2]| Rect::between(min.map(f64::from), max.map(|pixel| f64::from(pixel) + 1.0));
        let rect = match (extent, alone) {
            (Extent::Whole, Some(alone)) => of_pixels(alone.min, alone.max),
            _ => of_pixels(seen.visible.min, seen.visible.max),
        };
        let within = picture.boxes.iter().find(|known| known.id == id).map_or(0.0, |known| share_within(known, camera));
        Some(RoadUser {
            id,
            kind: class.to_string(),
            rect,
            pixels: seen.visible.pixels,
            visible: (1.0 - seen.occlusion.unwrap_or(0.0)) * within,
            distance,
        })
    };
    boxes(&picture.frame).unwrap_or_default().into_iter().filter_map(user).collect()
}

/// Returns the share of an object that the borders of the image leave, by the box around the corners of its box in space.
/// An object that reaches behind the camera has none.
fn share_within(known: &Box3, camera: &Camera) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in known.projected(camera) {
        let Some(corner) = corner else { return 0.0 };
        for (axis, number) in [corner.x, corner.y].into_iter().enumerate() {
            low[axis] = low[axis].min(number);
            high[axis] = high[axis].max(number);
        }
    }
    let whole = Rect::between(low, high);
    let inside = whole.within(f64::from(camera.width()), f64::from(camera.height()));
    inside.map_or(0.0, |inside| inside.area() / whole.area())
}

/// Returns the pixels of an image that show one of these semantic classes.
pub(crate) fn mask(picture: &Rendering, classes: &[String]) -> Mask {
    let frame = &picture.frame;
    let wanted: Vec<bool> = Semantic::names().iter().map(|name| classes.iter().any(|class| class == name)).collect();
    let shows = |number: &u8| wanted.get(usize::from(*number)).copied().unwrap_or(false);
    let pixels = frame.semantic.iter().flatten().map(shows).collect();
    Mask { width: frame.width(), height: frame.height(), pixels }
}
