//! Boxes as the COCO format has them (Lin et al. 2014): images, annotations, categories, and beside them what COCO does
//! not know: how much is hidden, and the box in space.

use super::{Picture, Shot};
use paracosm_render::{Box2, Box3, Semantic, boxes};
use serde::Serialize;

/// What `annotations.json` holds.
#[derive(Debug, Default, Serialize)]
pub(super) struct Annotations {
    images: Vec<Image>,
    annotations: Vec<Annotation>,
    categories: Vec<Category>,
}

#[derive(Debug, Serialize)]
struct Image {
    id: usize,
    file_name: String,
    width: u32,
    height: u32,
    camera: String,
    frame: u64,
    time: f64,
}

#[derive(Debug, Serialize)]
struct Annotation {
    id: usize,
    image_id: usize,
    category_id: u8,
    /// Left, top, width and height in pixels.
    bbox: [u32; 4],
    /// Pixels that are seen.
    area: u32,
    iscrowd: u8,
    /// The id in the instance image: the same thing has it in all images of a test.
    instance: u16,
    attributes: Attributes,
    #[serde(rename = "box3d")]
    in_space: Option<InSpace>,
}

#[derive(Debug, Serialize)]
struct Attributes {
    /// From 0, all of it is seen, to 1.
    occlusion: Option<f64>,
}

/// In the camera's coordinates: x forward, y to the left, z up, metres.
#[derive(Debug, Serialize)]
struct InSpace {
    center: [f64; 3],
    size: [f64; 3],
    /// A unit quaternion: w, x, y, z.
    rotation: [f64; 4],
}

#[derive(Debug, Serialize)]
struct Category {
    id: u8,
    name: &'static str,
}

impl Annotations {
    /// Nothing yet, in the classes that there are.
    pub fn new() -> Self {
        let categories = (0..).zip(Semantic::names()).map(|(id, name)| Category { id, name });
        Self { categories: categories.collect(), ..Self::default() }
    }

    /// Adds a picture of a camera that is, or would be, in this file.
    pub fn add(&mut self, camera: &str, file_name: String, shot: &Shot, picture: &Picture) {
        let image_id = self.images.len() + 1;
        let (width, height) = (picture.frame.width(), picture.frame.height());
        let (frame, time) = (shot.number, shot.time);
        self.images.push(Image { id: image_id, file_name, width, height, camera: camera.to_owned(), frame, time });
        for seen in boxes(&picture.frame).unwrap_or_default() {
            let in_space = picture.boxes.iter().find(|in_space| in_space.id == seen.visible.id);
            self.annotations.push(annotation(self.annotations.len() + 1, image_id, &seen, in_space));
        }
    }
}

fn annotation(id: usize, image_id: usize, seen: &Box2, in_space: Option<&Box3>) -> Annotation {
    let Box2 { visible, semantic, occlusion } = seen;
    let [left, top] = visible.min;
    Annotation {
        id,
        image_id,
        category_id: semantic.unwrap_or_default(),
        bbox: [left, top, visible.max[0] - left + 1, visible.max[1] - top + 1],
        area: visible.pixels,
        iscrowd: 0,
        instance: visible.id,
        attributes: Attributes { occlusion: *occlusion },
        in_space: in_space.map(|in_space| {
            let turn = in_space.pose.rotation.quaternion();
            InSpace {
                center: in_space.pose.translation.vector.into(),
                size: in_space.size.into(),
                rotation: [turn.w, turn.i, turn.j, turn.k],
            }
        }),
    }
}
