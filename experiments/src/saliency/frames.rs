//! Draws the images that the network is shown: the first image of a test behind a leader, with the leader elsewhere, in
//! another colour, or absent, so that nothing else differs.

use crate::cloning::{FOLLOW, driven};
use crate::scenario;
use paracosm::campaign::Worker;
use paracosm::engine::object::Colour;
use paracosm::engine::sensor::Image;
use paracosm::render::{Stages, WantedImages};
use paracosm::report::record::{Film, Projector, Shot};
use paracosm::space::{Value, Values};

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// The indices of the car and of the leader among the bodies, and the leader's id in the instance image.
const CAR: usize = 0;
const LEADER: usize = 1;
const LEADERS_ID: u16 = 2;

/// The place and the colour of a leader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scene {
    /// The distance between the bumpers in metres; `None` without a leader.
    pub gap: Option<f64>,
    /// The distance of the leader from the middle of the lane, in metres to the left.
    pub beside: f64,
    pub colour: Colour,
}

/// An image, with a mark for every pixel that shows the leader.
#[derive(Debug, Clone)]
pub struct Seen {
    pub image: Image,
    pub leader: Vec<bool>,
}

impl Seen {
    pub fn width(&self) -> usize {
        self.image.width as usize
    }

    pub fn height(&self) -> usize {
        self.image.height as usize
    }

    /// Returns the first and the last column, and the first and the last row, of the leader's pixels.
    pub fn bounds(&self) -> Option<[usize; 4]> {
        let width = self.width();
        let pixels = || self.leader.iter().enumerate().filter(|pixel| *pixel.1).map(|(i, _)| (i % width, i / width));
        let (left, right) = (pixels().map(|p| p.0).min()?, pixels().map(|p| p.0).max()?);
        let (top, bottom) = (pixels().map(|p| p.1).min()?, pixels().map(|p| p.1).max()?);
        Some([left, right, top, bottom])
    }

    /// Returns the mean colour of the leader's pixels.
    pub fn leaders_colour(&self) -> Colour {
        let count = self.leader.iter().filter(|mine| **mine).count().max(1);
        [0, 1, 2].map(|channel| {
            let mine = self.leader.iter().zip(self.image.rgb.chunks_exact(3)).filter(|(mine, _)| **mine);
            (mine.map(|(_, pixel)| usize::from(pixel[channel])).sum::<usize>() / count) as u8
        })
    }
}

/// A renderer of scenes with and without a leader.
pub struct Studio {
    projector: Projector,
    film: Film,
    /// The camera exposure that is altered to make each scene.
    first: Shot,
}

impl Studio {
    /// Opens a studio with the first image of a test in the training conditions.
    pub fn open() -> Result<Self, Failure> {
        let study = driven(scenario("follow-leader")?, FOLLOW.network()).build()?;
        let mut worker = Worker::new(&study)?;
        let test: Values = [("leader_speed".to_owned(), Value::Number(8.0))].into_iter().collect();
        let (trial, _) = worker.run(0, &test);
        let cameras = worker.eyes()?;
        let film = Film::of(&mut worker, &trial, &cameras, &Stages::default())?;
        let first = film.shots[0].first().ok_or("the camera takes no image")?.clone();
        let outputs = WantedImages { rgb: true, instance: true, ..WantedImages::default() };
        Ok(Self { projector: Projector::new(&cameras, outputs)?, film, first })
    }

    /// Draws these scenes and returns their images in order.
    pub fn draw(&mut self, scenes: &[Scene]) -> Result<Vec<Seen>, Failure> {
        self.film.shots[0] = scenes.iter().map(|scene| arranged(&self.first, scene)).collect();
        let mut seen = Vec::new();
        self.projector.show(&self.film, 0, |drawn| {
            seen.extend(drawn.into_iter().filter_map(|(_, picture)| {
                let frame = picture.ok()?.frame;
                let (width, height) = (frame.width(), frame.height());
                let image = Image { camera: 0, number: 0, time: 0.0, width, height, rgb: frame.rgb? };
                Some(Seen { image, leader: frame.instance?.iter().map(|id| *id == LEADERS_ID).collect() })
            }));
            Ok(())
        })?;
        if seen.len() == scenes.len() { Ok(seen) } else { Err("the camera is within a leader".into()) }
    }
}

/// Returns a copy of a shot with the leader at the place and in the colour that the scene gives.
fn arranged(shot: &Shot, scene: &Scene) -> Shot {
    let mut shot = shot.clone();
    let car = shot.moment.bodies[CAR];
    let leader = &mut shot.moment.bodies[LEADER];
    let lengths = car.body.outline.half_extent().x + leader.body.outline.half_extent().x;
    let ahead = car.pose.forward() * (scene.gap.unwrap_or_default() + lengths);
    leader.pose.position = car.pose.position + ahead + car.pose.left() * scene.beside;
    leader.body.colour = scene.colour;
    leader.present = scene.gap.is_some();
    shot
}
