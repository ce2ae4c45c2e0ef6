//! Images held against those of the folder `golden`. UPDATE_GOLDEN=1 writes them; look at what changed.

use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;

/// Pixels each way of the blocks that are compared.
const BLOCK: usize = 16;

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(format!("{name}.png"))
}

fn write(name: &str, width: u32, rgb: &[u8]) {
    let file = File::create(path(name)).expect("it can be written");
    let mut encoder = png::Encoder::new(file, width, rgb.len() as u32 / 3 / width);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().expect("it can be written");
    writer.write_image_data(rgb).expect("it can be written");
}

fn read(name: &str) -> Vec<u8> {
    let file = File::open(path(name)).unwrap_or_else(|error| panic!("{name}: {error}; UPDATE_GOLDEN=1 writes it"));
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().expect("a PNG");
    let mut rgb = vec![0; reader.output_buffer_size().expect("a small one")];
    reader.next_frame(&mut rgb).expect("a PNG");
    rgb
}

/// Holds an image against the one of this name: at most 1/255 between them on average, as on another adapter, and at
/// most 12/255 in any block, so that nothing is missed that is as large as a lamp.
pub fn compare(name: &str, width: u32, rgb: &[u8]) {
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        write(name, width, rgb);
    }
    let golden = read(name);
    assert_eq!(rgb.len(), golden.len(), "{name}");
    let apart: Vec<u8> = rgb.iter().zip(&golden).map(|(found, expected)| found.abs_diff(*expected)).collect();
    let mean = |off: &[u8]| off.iter().map(|off| f64::from(*off)).sum::<f64>() / off.len().max(1) as f64;
    let all = mean(&apart);
    eprintln!("{name}: {all:.4} / 255 on average");
    assert!(all < 1.0, "{name} is {all} / 255 off on average");
    let rows: Vec<&[u8]> = apart.chunks(3 * width as usize).collect();
    for (down, rows) in rows.chunks(BLOCK).enumerate() {
        for left in (0..width as usize).step_by(BLOCK) {
            let ends = 3 * left..3 * (left + BLOCK).min(width as usize);
            let block: Vec<u8> = rows.iter().flat_map(|row| &row[ends.clone()]).copied().collect();
            let off = mean(&block);
            assert!(off < 12.0, "{name} is {off} / 255 off at {left}, {}", down * BLOCK);
        }
    }
}
