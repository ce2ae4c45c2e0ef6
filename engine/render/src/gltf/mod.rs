//! Models that users bring along: glTF 2.0, as text or binary.
//!
//! A file becomes one mesh. Read are the triangles of all nodes of its scene, with their normals and texture coordinates, and of
//! the materials their base colours. Textures, animations, skins and morph targets are not.
//!
//! What a material is to light says its name, for glTF has no words for it: one that has `paint` in it gets the colour
//! of the body, one with `glass` in it, or that lets light through, is glass, one that shines is a lamp, red or white
//! by its colour. All others are dull, of their own colour.

mod bytes;

use crate::mesh::{Mesh, Semantic, SurfaceKind, Vertex};
use bytes::{Bytes, floats, indices};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::{Document, Gltf, Material, Node, Primitive};
use nalgebra::{Matrix4, Point3, Vector3};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// How deep nodes may lie within nodes: a file that is not sound may have them in circles.
const DEPTH: usize = 64;

/// Why a model cannot be used.
#[derive(Debug, Error)]
pub enum GltfError {
    /// A file cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Read {
        /// The model, or a file that it names.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is no glTF, or has something in it that is not supported.
    #[error("`{}` is no model that can be used: {problem}", path.display())]
    Format {
        /// The model.
        path: PathBuf,
        /// What was found and what was expected.
        problem: GltfFlaw,
    },
}

/// What keeps a file from being a model.
#[derive(Debug, Error)]
pub enum GltfFlaw {
    /// A binary file whose header says that it is shorter than its header.
    #[error("its header says that it has {bytes} bytes, expected at least 20")]
    Header {
        /// The length that it says.
        bytes: u32,
    },
    /// It is no glTF.
    #[error(transparent)]
    NoGltf(#[from] gltf::Error),
    /// It names an accessor that it does not have.
    #[error("it names its accessor {accessor}, but it has {count}")]
    NoAccessor {
        /// The accessor.
        accessor: usize,
        /// How many it has.
        count: usize,
    },
    /// It names a binary part that it does not have.
    #[error("it names a binary part that it does not have")]
    NoBinary,
    /// A buffer is not written in base64.
    #[error("a buffer in it is not written in base64")]
    NoBase64,
    /// An accessor of a kind that is not supported.
    #[error("its accessor {accessor} is sparse or has no buffer view")]
    NoView {
        /// The accessor.
        accessor: usize,
    },
    /// An accessor with more elements than bytes for them.
    #[error("its accessor {accessor} has {elements} elements, which is more than there are bytes for")]
    TooFewBytes {
        /// The accessor.
        accessor: usize,
        /// The number of its elements.
        elements: usize,
    },
    /// An accessor of other vectors than are needed.
    #[error("its accessor {accessor} has {shape:?} of {found:?}, expected {expected} numbers of F32 each")]
    NoFloats {
        /// The accessor.
        accessor: usize,
        /// The shape of its elements.
        shape: Dimensions,
        /// The type of its numbers.
        found: DataType,
        /// How many numbers an element should have.
        expected: usize,
    },
    /// An accessor of corners that are no whole numbers.
    #[error("its accessor {accessor} has indices of {found:?}, expected U8, U16 or U32")]
    NoIndices {
        /// The accessor.
        accessor: usize,
        /// The type of its numbers.
        found: DataType,
    },
    /// Nodes within nodes without end, or nearly so.
    #[error("its nodes lie more than {DEPTH} deep within each other")]
    TooDeep,
    /// A part that is not made of triangles.
    #[error("it is drawn of {found:?}, expected Triangles")]
    NoTriangleList {
        /// What it is made of.
        found: Mode,
    },
    /// A part without positions.
    #[error("a part of it has no positions")]
    NoPositions,
    /// A part whose corners do not fit each other.
    #[error("a part of it with {corners} corners says something of others, or has no whole triangles")]
    Corners {
        /// The number of its corners.
        corners: usize,
    },
    /// A position that is not finite.
    #[error("a position in it is no number")]
    NoPlace,
    /// It has nothing to draw.
    #[error("it has no triangles")]
    NoTriangles,
}

/// The corners and triangles that have been found.
#[derive(Default)]
struct Found {
    vertices: Vec<Vertex>,
    indices: Vec<u32>,
}

/// The mesh of a model, all of which is of one class. glTF has y up and z ahead: the mesh has z up and x ahead, and its
/// lengths as they are in the file. [`Stage::model`](crate::Stage::model) stretches it to a body.
///
/// # Errors
/// A file cannot be read, is no glTF 2.0, has no triangles, or needs an extension.
pub fn load(path: impl AsRef<Path>, semantic: Semantic) -> Result<Mesh, GltfError> {
    let path = path.as_ref();
    let file = std::fs::read(path).map_err(|source| GltfError::Read { path: path.to_owned(), source })?;
    let broken = |problem| GltfError::Format { path: path.to_owned(), problem };
    let (document, blob) = parse(&file).map_err(broken)?;
    let bytes = Bytes::of(&document, blob, path)?;
    let mut found = Found::default();
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let nodes: Vec<Node<'_>> = match &scene {
        Some(scene) => scene.nodes().collect(),
        None => document.nodes().collect(),
    };
    for node in nodes {
        found.add(&node, &upright(), &bytes, semantic, DEPTH).map_err(broken)?;
    }
    if found.indices.is_empty() {
        return Err(broken(GltfFlaw::NoTriangles));
    }
    Ok(Mesh::new(found.vertices, found.indices))
}

/// A document that says nothing of what it does not have, and the binary part of its file.
fn parse(file: &[u8]) -> Result<(Document, Option<Vec<u8>>), GltfFlaw> {
    // The reader takes for granted that a binary file says that it is longer than its header,
    if let Some(header) = file.strip_prefix(b"glTF") {
        let length =
            header.get(4..8).map_or(0, |bytes| bytes.iter().rev().fold(0, |all, byte| all << 8 | u32::from(*byte)));
        if length < 20 {
            return Err(GltfFlaw::Header { bytes: length });
        }
    }
    let Gltf { document, blob } = Gltf::from_slice_without_validation(file)?;
    // and the validation that there are the accessors that are named.
    let json = document.into_json();
    let count = json.accessors.len();
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    if let Some(index) = primitives.flat_map(|of| of.attributes.values()).find(|index| index.value() >= count) {
        return Err(GltfFlaw::NoAccessor { accessor: index.value(), count });
    }
    let document = Document::from_json(json)?;
    Ok((document, blob))
}

/// From glTF's axes (y up, z ahead, x to the left) to ours (z up, x ahead, y to the left).
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
        let positions: Vec<[f32; 3]> = floats(&positions, bytes)?;
        let count = positions.len();
        let of_each = |semantic| primitive.get(&semantic).map(|accessor| (semantic, accessor));
        let normals: Option<Vec<[f32; 3]>> =
            of_each(gltf::Semantic::Normals).map(|(_, normals)| floats(&normals, bytes)).transpose()?;
        let uvs: Option<Vec<[f32; 2]>> = match of_each(gltf::Semantic::TexCoords(0)) {
            Some((_, uvs)) if uvs.data_type() == DataType::F32 => Some(floats(&uvs, bytes)?),
            _ => None,
        };
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
        let (surface, colour) = look(&primitive.material());
        for triangle in indices.chunks_exact(3) {
            let at = |corner: u32| frame.transform_point(&Point3::from(positions[corner as usize])).coords;
            let corners = [triangle[0], triangle[if mirrored { 2 } else { 1 }], triangle[if mirrored { 1 } else { 2 }]];
            let [a, b, c] = corners.map(at);
            let Some(flat) = (b - a).cross(&(c - a)).try_normalize(0.0) else { continue };
            if !flat.iter().all(|number| number.is_finite()) {
                return Err(GltfFlaw::NoPlace);
            }
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

/// What a material is to light, and its colour.
fn look(material: &Material<'_>) -> (SurfaceKind, [f32; 3]) {
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
