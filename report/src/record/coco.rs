//! Writes boxes and masks in the COCO format (Lin et al. 2014): images, annotations and categories. The files have two fields
//! that COCO does not define: the hidden share of an object, and its box in space.

use super::mask::masks;
use super::{Rendering, Shot};
use paracosm_campaign::Error;
use paracosm_campaign::files::read_text;
use paracosm_render::{Box2, Box3, Semantic, boxes, is_only_pictured};
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use std::path::Path;

/// The name of the file of boxes; each test has such a file, and so has the whole data set.
pub(super) const ANNOTATIONS: &str = "annotations.json";

/// The contents of a file of boxes.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Annotations {
    images: Vec<Image>,
    annotations: Vec<Annotation>,
    categories: Vec<Category>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Image {
    id: usize,
    /// The path of the colour image or, without a colour image, of another image that is kept, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    file_name: Option<String>,
    width: u32,
    height: u32,
    camera: String,
    frame: u64,
    time: f64,
}

#[derive(Debug, Serialize, Deserialize)]
struct Annotation {
    id: usize,
    image_id: usize,
    category_id: u8,
    /// The left edge, the top edge, the width and the height of the box around the visible pixels, in pixels.
    bbox: [u32; 4],
    /// The number of visible pixels of the object.
    area: u32,
    /// The visible pixels of the object; `None` in recordings of version 0.2.0 and before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    segmentation: Option<Segmentation>,
    /// 1 for an object that a detector should neither be rewarded nor punished for, because it exists only in pictures.
    iscrowd: u8,
    /// The id of the object in the images of ids, which is the same in all images of a test.
    instance: u16,
    attributes: Attributes,
    #[serde(rename = "box3d")]
    in_space: Option<InSpace>,
}

/// The visible pixels of an object, as `pycocotools` reads them.
#[derive(Debug, Serialize, Deserialize)]
struct Segmentation {
    /// The height and the width of the image.
    size: [u32; 2],
    /// The run-length encoding.
    counts: String,
}

#[derive(Debug, Serialize, Deserialize)]
struct Attributes {
    /// The hidden share of the object's pixels, from 0 (the whole object is visible) to 1.
    occlusion: Option<f64>,
}

/// A box in the camera's coordinates: x forward, y to the left, z up, in metres.
#[derive(Debug, Serialize, Deserialize)]
struct InSpace {
    center: [f64; 3],
    size: [f64; 3],
    /// The rotation of the box as a unit quaternion w, x, y, z.
    rotation: [f64; 4],
}

#[derive(Debug, Serialize, Deserialize)]
struct Category {
    id: u8,
    name: String,
}

impl Annotations {
    /// Makes the contents of a COCO file that lists all classes and no image.
    pub fn new() -> Self {
        let categories = (0..).zip(Semantic::names()).map(|(id, name)| Category { id, name: (*name).to_owned() });
        Self { categories: categories.collect(), ..Self::default() }
    }

    /// Adds an image of a camera to the COCO file, with the boxes of the visible objects. `file_name` is `None` if the
    /// image itself is not kept.
    pub fn add(&mut self, camera: &str, file_name: Option<String>, shot: &Shot, picture: &Rendering) {
        let image_id = self.images.len() + 1;
        let (width, height) = (picture.frame.width(), picture.frame.height());
        let (frame, time) = (shot.number, shot.time);
        self.images.push(Image { id: image_id, file_name, width, height, camera: camera.to_owned(), frame, time });
        let mut masks = masks(picture.frame.instance.as_deref().unwrap_or_default(), width as usize);
        for seen in boxes(&picture.frame).unwrap_or_default() {
            let counts = masks.remove(&seen.visible.id).unwrap_or_default();
            let segmentation = Segmentation { size: [height, width], counts };
            let in_space = picture.boxes.iter().find(|in_space| in_space.id == seen.visible.id);
            self.annotations.push(annotation([self.annotations.len() + 1, image_id], &seen, segmentation, in_space));
        }
    }
}

/// Merges the annotations of many tests into one file. Ids continue from test to test, and names of files begin with
/// the folder of the test. `tests` are the names of the folders below `top`. Only one test is in memory at a time.
pub(super) fn merge(top: &Path, tests: &[String], file: &mut impl Write) -> Result<(), Error> {
    let failed = |error: io::Error| Error::io("write", &top.join(ANNOTATIONS))(error);
    let read = |test: &String| -> Result<Annotations, Error> {
        let path = top.join(test).join(ANNOTATIONS);
        let text = read_text(&path)?;
        serde_json::from_str(&text).map_err(|error| Error::in_file(&path, error.line(), error))
    };
    let mut lists = Lists { first: true, file };
    lists.write("{\n\"images\": [").map_err(failed)?;
    let mut before = 0;
    for test in tests {
        let mut images = read(test)?.images;
        for image in &mut images {
            image.id += before;
            image.file_name = image.file_name.take().map(|name| format!("{test}/{name}"));
            lists.add(image).map_err(failed)?;
        }
        before += images.len();
    }
    lists.write("\n],\n\"annotations\": [").map_err(failed)?;
    let (mut before, mut images_before) = (0, 0);
    for test in tests {
        let Annotations { images, mut annotations, .. } = read(test)?;
        for annotation in &mut annotations {
            annotation.id += before;
            annotation.image_id += images_before;
            lists.add(annotation).map_err(failed)?;
        }
        before += annotations.len();
        images_before += images.len();
    }
    lists.write("\n],\n\"categories\": [").map_err(failed)?;
    Annotations::new().categories.iter().try_for_each(|category| lists.add(category)).map_err(failed)?;
    lists.write("\n]\n}\n").and_then(|()| lists.file.flush()).map_err(failed)
}

/// A writer of lists in JSON, element by element.
struct Lists<'a, W> {
    first: bool,
    file: &'a mut W,
}

impl<W: Write> Lists<'_, W> {
    /// Writes the text between two lists of the merged file. The next element is then the first element of its list.
    fn write(&mut self, text: &str) -> io::Result<()> {
        self.first = true;
        self.file.write_all(text.as_bytes())
    }

    fn add(&mut self, element: &impl Serialize) -> io::Result<()> {
        self.file.write_all(if std::mem::take(&mut self.first) { b"\n" } else { b",\n" })?;
        serde_json::to_writer(&mut self.file, element).map_err(io::Error::from)
    }
}

fn annotation(
    [id, image_id]: [usize; 2],
    seen: &Box2,
    segmentation: Segmentation,
    in_space: Option<&Box3>,
) -> Annotation {
    let Box2 { visible, semantic, occlusion } = seen;
    let [left, top] = visible.min;
    Annotation {
        id,
        image_id,
        category_id: semantic.unwrap_or_default(),
        bbox: [left, top, visible.max[0] - left + 1, visible.max[1] - top + 1],
        area: visible.pixels,
        segmentation: Some(segmentation),
        iscrowd: u8::from(is_only_pictured(visible.id)),
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
