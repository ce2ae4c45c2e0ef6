//! Reads models of users: glTF 2.0, as text or binary.
//!
//! A file becomes one mesh. The reader takes the triangles of all nodes of the file's scene, with their normals and
//! texture coordinates, and the base colours of the materials. In the look `textured` it also takes the images of the base
//! colours, which are PNG or JPEG images, repeat, and have no transparency. It ignores other textures, animations, skins
//! and morph targets.
//!
//! The name of a material says how the surface reacts to light, because glTF has no property for it. A material whose
//! name contains `paint` gets the colour of the body. A material whose name contains `glass`, or that lets light
//! through, is glass. A material that shines is a lamp, red or white by its colour. All other materials are dull and
//! have their own colour.

mod bytes;
mod pictures;

pub use pictures::ImageFlaw;

use crate::Look;
use crate::mesh::picture::MOST;
use crate::mesh::{Mesh, Semantic, SurfaceKind, Vertex};
use bytes::{Bytes, MOST_MEBIBYTES, floats, indices};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::{Document, Gltf, Material, Node, Primitive};
use nalgebra::{Matrix4, Point3, Vector3};
use pictures::Pictures;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The greatest depth of nodes within nodes.
const DEPTH: usize = 64;

/// The greatest number of corners and indices that the nodes of a model draw together: a million triangles with corners
/// of their own.
const MOST_CORNERS: usize = 6_000_000;

/// The greatest number of objects in the description of a model, such as nodes and materials. Bytes of buffers that look
/// like the beginning of an object count, too: one of 256 on average, so as many as a file of 256 MiB may have.
const MOST_OBJECTS: usize = 2_000_000;

/// The reason why a file cannot be used as a model of an object.
#[derive(Debug, Error)]
pub enum GltfError {
    /// The model file, or a file to which the model file refers, cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Read {
        /// The path of the file that cannot be read.
        path: PathBuf,
        /// The operating system's error for the file.
        source: std::io::Error,
    },
    /// The file is not in the format glTF, or uses a feature of glTF that is not supported.
    #[error("`{}` cannot be used as a model: {problem}", path.display())]
    Format {
        /// The path of the model file.
        path: PathBuf,
        /// The flaw of the model file, with the found and the expected content.
        problem: GltfFlaw,
    },
}

/// The flaw of a file that was to be read as a glTF model.
#[derive(Debug, Error)]
pub enum GltfFlaw {
    /// The description of the model has too many objects.
    #[error("it has more than {MOST_OBJECTS} objects such as nodes, which is the limit: reduce the model")]
    TooManyObjects,
    /// The header of a binary file states a length that is shorter than the header.
    #[error("its header says that it has {bytes} bytes, expected at least 20")]
    Header {
        /// The length in bytes that the header states.
        bytes: u32,
    },
    /// The file is not in the format glTF.
    #[error(transparent)]
    NoGltf(#[from] gltf::Error),
    /// The file refers to a glTF accessor that the file does not contain.
    #[error("it names accessor {accessor}, but its number of accessors is {count}")]
    NoAccessor {
        /// The index of the accessor in the glTF file.
        accessor: usize,
        /// The number of accessors that the file contains.
        count: usize,
    },
    /// The file refers to a binary part that the file does not contain.
    #[error("a buffer refers to the binary part of the file, but the file has none")]
    NoBinary,
    /// The text of a buffer in the file is not valid base64.
    #[error("a buffer or an image in it is not valid base64")]
    NoBase64,
    /// A glTF accessor is sparse or has no buffer view, which is not supported.
    #[error("its accessor {accessor} is sparse or has no buffer view")]
    NoView {
        /// The index of the accessor in the glTF file.
        accessor: usize,
    },
    /// A glTF accessor needs more bytes than the file contains.
    #[error("the file has too few bytes for its accessor {accessor}: number of elements {elements}")]
    TooFewBytes {
        /// The index of the accessor in the glTF file.
        accessor: usize,
        /// The number of elements that the accessor states.
        elements: usize,
    },
    /// The elements of a glTF accessor are not vectors of 32-bit floating-point numbers of the expected length.
    #[error("its accessor {accessor} has {shape:?} of {found:?}, expected vectors of {expected} F32 numbers")]
    NoFloats {
        /// The index of the accessor in the glTF file.
        accessor: usize,
        /// The shape of the accessor's elements.
        shape: Dimensions,
        /// The type of the numbers in the accessor.
        found: DataType,
        /// The expected number of components of each vector.
        expected: usize,
    },
    /// A glTF accessor for indices has numbers that are not unsigned integers.
    #[error("its accessor {accessor} has indices of {found:?}, expected U8, U16 or U32")]
    NoIndices {
        /// The index of the accessor in the glTF file.
        accessor: usize,
        /// The type of the numbers in the accessor.
        found: DataType,
    },
    /// A node is the child of two nodes, or is listed twice.
    #[error("its node {node} is the child of two nodes or listed twice, expected a tree")]
    NoTree {
        /// The index of the node in the glTF file.
        node: usize,
    },
    /// The nodes of the model draw too many corners.
    #[error(
        "its nodes draw more than {MOST_CORNERS} corners and indices, which is the limit: reduce the triangles of the model"
    )]
    TooManyCorners,
    /// The file, together with the files of its buffers, is too large.
    #[error("it has more than {MOST_MEBIBYTES} MiB with its buffers, which is the limit: reduce the model")]
    TooLarge,
    /// A buffer or an image is in a file that is not below the folder of the model.
    #[error("a buffer or an image is in `{uri}`, expected a file in the folder of the model or below this folder")]
    Outside {
        /// The reference to the file, as it is in the model.
        uri: String,
    },
    /// A buffer or an image is in something that is no regular file, for example a pipe or a device.
    #[error("a buffer or an image is in `{uri}`, which is no regular file")]
    NoFile {
        /// The reference to the file, as it is in the model.
        uri: String,
    },
    /// The glTF nodes are nested too deep.
    #[error("its nodes lie more than {DEPTH} deep within each other")]
    TooDeep,
    /// A glTF primitive of the model is not a list of triangles.
    #[error("a part of it is made of {found:?}, expected Triangles")]
    NoTriangleList {
        /// The kind of the glTF primitive, for example lines.
        found: Mode,
    },
    /// A glTF primitive of the model has no positions.
    #[error("a part of it has no positions")]
    NoPositions,
    /// The normals, texture coordinates or indices of a glTF primitive do not match the number of its corners.
    #[error("the normals, texture coordinates or indices of a part do not match its corners ({corners})")]
    Corners {
        /// The number of corners of the glTF primitive.
        corners: usize,
    },
    /// A position in the model has a number that is not finite.
    #[error("a position in it is not a finite number")]
    NoPlace,
    /// The model has too many images.
    #[error("its base colours have more than {MOST} images, which is the limit: join them")]
    TooManyImages,
    /// An image of a base colour cannot be used.
    #[error("its image {image} cannot be used: {problem}")]
    NoImage {
        /// The index of the image in the glTF file.
        image: usize,
        /// The flaw of the image.
        problem: ImageFlaw,
    },
    /// The model has no triangles.
    #[error("it has no triangles")]
    NoTriangles,
}

/// The corners and triangles that were found so far.
#[derive(Default)]
struct Found {
    vertices: Vec<Vertex>,
    indices: Vec<u32>,
    pictures: Pictures,
    /// For each triangle the place of its picture, if it has one.
    pictured: Vec<Option<u8>>,
    /// True for each node that was found.
    nodes: Vec<bool>,
    /// The number of corners and indices that were read.
    read: usize,
}

/// Reads a glTF file as a mesh of one semantic class. glTF has y up and z ahead; the mesh has z up and x ahead. Lengths
/// stay as they are in the file: [`Stage::model`](crate::Stage::model) stretches the mesh to a body.
///
/// # Errors
/// A file cannot be read, is not glTF 2.0, has no triangles, is beyond a limit, or needs an extension. Buffers are read
/// only from regular files in the folder of the model.
pub fn load(path: impl AsRef<Path>, semantic: Semantic) -> Result<Mesh, GltfError> {
    load_in_look(path, semantic, Look::Flat)
}

/// Reads a glTF file as a mesh like [`load`], for scenes of one look. In the look [`Textured`](Look::Textured), the mesh
/// has the images of the base colours.
///
/// # Errors
/// As for [`load`]; or an image is neither a PNG nor a JPEG image, is broken, or is beyond a limit.
pub fn load_in_look(path: impl AsRef<Path>, semantic: Semantic, look: Look) -> Result<Mesh, GltfError> {
    let path = path.as_ref();
    let broken = |problem| GltfError::Format { path: path.to_owned(), problem };
    let mut left = MOST_MEBIBYTES << 20;
    let file = bytes::read(path, &mut left).map_err(|source| GltfError::Read { path: path.to_owned(), source })?;
    let file = file.ok_or_else(|| broken(GltfFlaw::TooLarge))?;
    let (document, blob) = parse(&file).map_err(broken)?;
    let bytes = Bytes::of(&document, blob, path, &mut left)?;
    let pictures = match look {
        Look::Flat => Pictures::default(),
        Look::Textured => Pictures::of(&document, &bytes, path, &mut left)?,
    };
    let mut found = Found { pictures, nodes: vec![false; document.nodes().len()], ..Found::default() };
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let children: BTreeSet<usize> =
        document.nodes().flat_map(|node| node.children()).map(|node| node.index()).collect();
    let nodes: Vec<Node<'_>> = match &scene {
        Some(scene) => scene.nodes().collect(),
        None => document.nodes().filter(|node| !children.contains(&node.index())).collect(),
    };
    for node in nodes {
        found.add(&node, &upright(), &bytes, semantic, DEPTH).map_err(broken)?;
    }
    if found.indices.is_empty() {
        return Err(broken(GltfFlaw::NoTriangles));
    }
    Ok(Mesh::new(found.vertices, found.indices).with_pictures(found.pictures.all, found.pictured))
}

/// Returns the checked document, and the binary part of the file.
fn parse(file: &[u8]) -> Result<(Document, Option<Vec<u8>>), GltfFlaw> {
    // The parser takes for granted that the length in a binary file's header covers the header,
    if let Some(header) = file.strip_prefix(b"glTF") {
        let length =
            header.get(4..8).map_or(0, |bytes| bytes.iter().rev().fold(0, |all, byte| all << 8 | u32::from(*byte)));
        if length < 20 {
            return Err(GltfFlaw::Header { bytes: length });
        }
    }
    // Each object of the JSON takes some hundred bytes of memory.
    if file.iter().filter(|byte| **byte == b'{').count() > MOST_OBJECTS {
        return Err(GltfFlaw::TooManyObjects);
    }
    let Gltf { document, blob } = Gltf::from_slice_without_validation(file)?;
    // and its validation takes for granted that all named accessors exist.
    let json = document.into_json();
    let count = json.accessors.len();
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    if let Some(index) = primitives.flat_map(|of| of.attributes.values()).find(|index| index.value() >= count) {
        return Err(GltfFlaw::NoAccessor { accessor: index.value(), count });
    }
    let document = Document::from_json(json)?;
    Ok((document, blob))
}

/// Returns the transformation from glTF's axes (y up, z ahead, x to the left) to ours (z up, x ahead, y to the left).
fn upright() -> Matrix4<f32> {
    #[rustfmt::skip]
    let axes = Matrix4::new(
        0.0, 0.0, 1.0, 0.0,
        1.0, 0.0, 0.0, 0.0,
        0.0, 1.0, 0.0, 0.0,
        0.0, 0.0, 0.0, 1.0,
    );
    axes
}

impl Found {
    fn add(
        &mut self,
        node: &Node<'_>,
        frame: &Matrix4<f32>,
        bytes: &Bytes,
        semantic: Semantic,
        depth: usize,
    ) -> Result<(), GltfFlaw> {
        if depth == 0 {
            return Err(GltfFlaw::TooDeep);
        }
        if std::mem::replace(&mut self.nodes[node.index()], true) {
            return Err(GltfFlaw::NoTree { node: node.index() });
        }
        let frame = frame * Matrix4::from(node.transform().matrix());
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            self.add_primitive(&primitive, &frame, bytes, semantic)?;
        }
        node.children().try_for_each(|child| self.add(&child, &frame, bytes, semantic, depth - 1))
    }

    fn add_primitive(
        &mut self,
        primitive: &Primitive<'_>,
        frame: &Matrix4<f32>,
        bytes: &Bytes,
        semantic: Semantic,
    ) -> Result<(), GltfFlaw> {
        if primitive.mode() != Mode::Triangles {
            return Err(GltfFlaw::NoTriangleList { found: primitive.mode() });
        }
        let positions = primitive.get(&gltf::Semantic::Positions).ok_or(GltfFlaw::NoPositions)?;
        // Several nodes may draw the same mesh.
        let indices_count = primitive.indices().map_or(0, |accessor| accessor.count());
        self.read = self.read.saturating_add(positions.count()).saturating_add(indices_count);
        if self.read > MOST_CORNERS {
            return Err(GltfFlaw::TooManyCorners);
        }
        let positions: Vec<[f32; 3]> = floats(&positions, bytes)?;
        let count = positions.len();
        let of_each = |semantic| primitive.get(&semantic).map(|accessor| (semantic, accessor));
        let normals: Option<Vec<[f32; 3]>> =
            of_each(gltf::Semantic::Normals).map(|(_, normals)| floats(&normals, bytes)).transpose()?;
        let picture = self.pictures.place(&primitive.material());
        let uvs: Option<Vec<[f32; 2]>> = match of_each(gltf::Semantic::TexCoords(picture.map_or(0, |(_, set)| set))) {
            Some((_, uvs)) if picture.is_some() || uvs.data_type() == DataType::F32 => Some(floats(&uvs, bytes)?),
            _ => None,
        };
        let picture = picture.filter(|_| uvs.is_some()).map(|(place, _)| place);
        let indices = match primitive.indices() {
            Some(accessor) => indices(&accessor, bytes)?,
            None => (0..count as u32).collect(),
        };
        let lengths = [normals.as_ref().map_or(count, Vec::len), uvs.as_ref().map_or(count, Vec::len)];
        if lengths != [count; 2] || indices.iter().any(|index| *index as usize >= count) || indices.len() % 3 != 0 {
            return Err(GltfFlaw::Corners { corners: count });
        }
        let place = frame.fixed_view::<3, 3>(0, 0).into_owned();
        let Some(turn) = place.try_inverse().map(|inverse| inverse.transpose()) else { return Ok(()) };
        let mirrored = place.determinant() < 0.0;
        let (surface, colour) = finish(&primitive.material());
        for triangle in indices.chunks_exact(3) {
            let at = |corner: u32| frame.transform_point(&Point3::from(positions[corner as usize])).coords;
            let corners = [triangle[0], triangle[if mirrored { 2 } else { 1 }], triangle[if mirrored { 1 } else { 2 }]];
            let [a, b, c] = corners.map(at);
            let Some(flat) = (b - a).cross(&(c - a)).try_normalize(0.0) else { continue };
            if !flat.iter().all(|number| number.is_finite()) {
                return Err(GltfFlaw::NoPlace);
            }
            self.pictured.push(picture);
            for (corner, position) in corners.into_iter().zip([a, b, c]) {
                let own = normals.as_ref().and_then(|normals| {
                    (turn * Vector3::from(normals[corner as usize])).try_normalize(f32::MIN_POSITIVE)
                });
                let normal = own.filter(|normal| normal.iter().all(|number| number.is_finite())).unwrap_or(flat);
                self.indices.push(self.vertices.len() as u32);
                self.vertices.push(Vertex {
                    position: position.into(),
                    normal: normal.into(),
                    uv: uvs.as_ref().map_or([0.0; 2], |uvs| uvs[corner as usize]),
                    colour,
                    surface,
                    semantic,
                });
            }
        }
        Ok(())
    }
}

/// Returns the surface kind and the colour of a material.
fn finish(material: &Material<'_>) -> (SurfaceKind, [f32; 3]) {
    let [red, green, blue, _] = material.pbr_metallic_roughness().base_color_factor();
    let base = [red, green, blue];
    let name = material.name().unwrap_or_default().to_lowercase();
    let shine = material.emissive_factor();
    if name.contains("paint") {
        (SurfaceKind::Paint, base)
    } else if name.contains("glass") || material.alpha_mode() == gltf::material::AlphaMode::Blend {
        (SurfaceKind::Glass, base)
    } else if shine.iter().any(|level| *level > 0.0) {
        let red = shine[0] > 2.0 * shine[1].max(shine[2]);
        (if red { SurfaceKind::RedLamp } else { SurfaceKind::WhiteLamp }, shine)
    } else {
        (SurfaceKind::Plain, base)
    }
}
