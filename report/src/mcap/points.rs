//! The scans of a LiDAR as point clouds.

use super::recorder::{LIDAR, Recorder, Scanned};
use super::scene::{frame, stamp};
use super::tape::Tape;
use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{FrameTransforms, PackedElementField, PointCloud};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use paracosm_campaign::Error;
use paracosm_engine::sensor::{LidarPoint, Scan};
use std::io::{Seek, Write};

/// The fields of a point, four bytes each.
const FIELDS: [(&str, NumericType); 5] = [
    ("x", NumericType::Float32),
    ("y", NumericType::Float32),
    ("z", NumericType::Float32),
    ("intensity", NumericType::Float32),
    // The index of the body that gave the echo, plus one; 0 for the ground.
    ("body", NumericType::Uint32),
];
const STRIDE: u32 = 4 * FIELDS.len() as u32;

/// Adds the messages of the scans.
pub(super) fn tell<W: Write + Seek>(recorder: &Recorder, tape: &mut Tape<W>) -> Result<(), Error> {
    let Some(Scanned { mount, scans, .. }) = &recorder.lidar else { return Ok(()) };
    let Some((first, _)) = scans.first() else { return Ok(()) };
    let frames = tape.topic::<FrameTransforms>(&format!("/tf/{LIDAR}"), &[])?;
    let clouds = tape.topic::<PointCloud>(&format!("/{LIDAR}/points"), &[])?;
    let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, mount.heading);
    let at = Isometry3::from_parts(Translation3::from(mount.position), turn);
    let transforms = vec![frame(stamp(*first), recorder.ego(), LIDAR, &at)];
    tape.say(frames, *first, &FrameTransforms { transforms });
    for (time, scan) in scans {
        tape.say(clouds, *time, &cloud(*time, scan));
    }
    Ok(())
}

fn cloud(time: f64, scan: &Scan) -> PointCloud {
    let field = |(place, (name, kind)): (usize, (&str, NumericType))| PackedElementField {
        name: name.to_owned(),
        offset: 4 * place as u32,
        r#type: kind.into(),
    };
    let bytes = |LidarPoint { position, intensity, id }: &LidarPoint| {
        let numbers = [position.x, position.y, position.z, *intensity].map(f32::to_le_bytes);
        numbers.into_iter().chain([id.to_le_bytes()]).flatten()
    };
    PointCloud {
        timestamp: stamp(time),
        frame_id: LIDAR.to_owned(),
        pose: None,
        point_stride: STRIDE,
        fields: FIELDS.into_iter().enumerate().map(field).collect(),
        data: scan.points.iter().flat_map(bytes).collect::<Vec<u8>>().into(),
    }
}
