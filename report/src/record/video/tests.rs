//! Files of films, taken apart box by box.

use super::*;
use std::io::Cursor;

/// The boxes that lie one after the other in these bytes, which they fill.
fn boxes(mut bytes: &[u8]) -> Vec<(&str, &[u8])> {
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let short = u64::from(u32::from_be_bytes(bytes[..4].try_into().unwrap()));
        let (size, head) = match short {
            1 => (u64::from_be_bytes(bytes[8..16].try_into().unwrap()), 16),
            size => (size, 8),
        };
        let (this, rest) = bytes.split_at(size as usize);
        found.push((std::str::from_utf8(&this[4..8]).unwrap(), &this[head..]));
        bytes = rest;
    }
    found
}

/// What is in the box at the end of a path of boxes of boxes.
fn inside<'a>(bytes: &'a [u8], path: &str) -> &'a [u8] {
    path.split('/').fold(bytes, |bytes, kind| {
        let found = boxes(bytes).into_iter().find(|(name, _)| *name == kind);
        found.unwrap_or_else(|| panic!("there is no {kind} of {path}")).1
    })
}

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_be_bytes(word.try_into().unwrap())).collect()
}

/// A table of a film, after its version.
fn table(file: &[u8], name: &str) -> Vec<u32> {
    words(&inside(file, &format!("moov/trak/mdia/minf/stbl/{name}"))[4..])
}

/// A film of a bright square that moves over a dark ground, with pictures at these times.
fn film(size: [u32; 2], rate: f64, times: &[f64]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut video = Video::begin(&mut file, size, rate).unwrap();
    for (i, time) in times.iter().enumerate() {
        let pixel = |x: u32, y: u32| if (x + y).abs_diff(i as u32) < 6 { [250, 220, 30] } else { [30, 40, 50] };
        let rgb: Vec<u8> = (0..size[1]).flat_map(|y| (0..size[0]).flat_map(move |x| pixel(x, y))).collect();
        video.show(&rgb, *time).unwrap();
    }
    video.end().unwrap();
    file.into_inner()
}

fn every(rate: f64, pictures: usize) -> Vec<f64> {
    (0..pictures).map(|i| i as f64 / rate).collect()
}

#[test]
fn all_pictures_of_half_a_minute_are_in_the_file_at_their_times_with_keys_to_jump_to() {
    let file = film([48, 32], 30.0, &every(30.0, 900));
    assert_eq!(boxes(&file).iter().map(|(kind, _)| *kind).collect::<Vec<_>>(), ["ftyp", "mdat", "moov"]);
    let sizes = table(&file, "stsz");
    assert_eq!(sizes[..2], [0, 900]);
    let pictures = inside(&file, "mdat");
    assert_eq!(sizes[2..].iter().sum::<u32>() as usize, pictures.len());
    assert_eq!(table(&file, "stco"), [1, 48]);
    assert!(std::ptr::eq(&raw const file[48], &raw const pictures[0]));
    assert_eq!(table(&file, "stsc"), [1, 1, 900, 1]);
    // One run of equal durations: 30 s of 90,000 ticks.
    assert_eq!(table(&file, "stts"), [1, 900, 3000]);
    assert_eq!(words(&inside(&file, "moov/mvhd")[12..20]), [90_000, 2_700_000]);
    assert_eq!(words(&inside(&file, "moov/trak/mdia/mdhd")[12..20]), [90_000, 2_700_000]);
    let keys = table(&file, "stss");
    assert_eq!(keys[1..], (0..18).map(|key| 1 + 50 * key).collect::<Vec<_>>());
    // Each picture is a unit with its length before it; a key is an IDR picture (5), any other one is not (1).
    let mut left = pictures;
    for (number, size) in (1..).zip(&sizes[2..]) {
        let (picture, rest) = left.split_at(*size as usize);
        assert_eq!(words(picture)[0] + 4, *size, "picture {number}");
        assert_eq!(picture[4] & 31, if keys[1..].contains(&number) { 5 } else { 1 }, "picture {number}");
        left = rest;
    }
}

#[test]
fn what_a_player_has_to_know_is_said_of_the_pictures() {
    let file = film([48, 32], 10.0, &every(10.0, 2));
    let coding = &inside(&file, "moov/trak/mdia/minf/stbl/stsd")[8..];
    let coding = inside(coding, "avc1");
    assert_eq!(coding[24..28], [0, 48, 0, 32]);
    let settings = inside(&coding[78..], "avcC");
    // Constrained baseline: profile 66 with the second constraint; level 4; lengths of four bytes; one unit of each
    // kind.
    assert_eq!((settings[1], settings[2] & 0x40, settings[3], settings[4], settings[5]), (66, 0x40, 40, 0xFF, 0xE1));
    let length = usize::from(u16::from_be_bytes([settings[6], settings[7]]));
    assert_eq!(settings[8..12], [0x67, settings[1], settings[2], settings[3]]);
    assert_eq!((settings[8 + length], settings[8 + length + 3]), (1, 0x68));
    assert_eq!(inside(&coding[78..], "colr"), b"nclx\0\x01\0\x01\0\x06\0");
}

#[test]
fn odd_sizes_are_rounded_up_and_a_film_may_be_one_picture() {
    for ([width, height], even) in [([41, 25], [42, 26]), ([1, 1], [2, 2]), ([16, 17], [16, 18])] {
        let file = film([width, height], 10.0, &[0.0]);
        let header = words(&inside(&file, "moov/trak/tkhd")[76..]);
        assert_eq!(header, even.map(|pixels| pixels << 16));
        assert_eq!(table(&file, "stts"), [1, 1, 9000]);
        assert_eq!(table(&file, "stss"), [1, 1]);
    }
}

#[test]
fn a_film_runs_at_the_right_speed_where_images_were_lost_and_rates_are_no_whole_ticks() {
    let durations = |rate: f64, times: &[f64]| {
        let runs = table(&film([16, 16], rate, times), "stts");
        let runs = runs[1..].chunks_exact(2).map(|run| vec![run[1]; run[0] as usize]);
        runs.flatten().collect::<Vec<u32>>()
    };
    // Before its first image, the film is black for half a second.
    assert_eq!(durations(10.0, &[0.5, 0.6, 1.0, 1.1]), [45_000, 9000, 36_000, 9000, 9000]);
    let found = durations(7.0, &every(7.0, 50));
    assert_eq!(found.len(), 50);
    assert_eq!(found.iter().sum::<u32>(), (50.0 / 7.0 * 90_000.0_f64).round() as u32);
}

#[test]
fn brightness_and_colours_are_those_of_the_standards() {
    for (height, [red, green, blue]) in [(4, [0.299, 0.587, 0.114]), (720, [0.2126, 0.7152, 0.0722])] {
        let mut planes = Planes::new([3, height]);
        assert_eq!(planes.size(), [4, height]);
        for rgb in [[0, 0, 0], [255, 255, 255], [255, 0, 0], [0, 255, 0], [0, 0, 255], [12, 200, 77]] {
            planes.take(&rgb.repeat(3 * height as usize));
            let [r, g, b] = rgb.map(|part| f64::from(part) / 255.0);
            let bright = red * r + green * g + blue * b;
            let expected = [
                16.0 + 219.0 * bright,
                128.0 + 224.0 * (b - bright) / (2.0 - 2.0 * blue),
                128.0 + 224.0 * (r - bright) / (2.0 - 2.0 * red),
            ];
            for (plane, expected) in planes.all().into_iter().zip(expected) {
                assert!(plane.iter().all(|found| (f64::from(*found) - expected).abs() <= 0.501), "{rgb:?} {expected}");
            }
        }
    }
    // The last column is repeated, and a square has the mean of its colours.
    let mut planes = Planes::new([3, 2]);
    let (black, white) = ([0, 0, 0], [255, 255, 255]);
    planes.take(&[black, white, black, black, white, white].concat());
    assert_eq!(planes.all()[0], [16, 235, 16, 16, 16, 235, 235, 235]);
    let mut planes = Planes::new([2, 2]);
    planes.take(&[[255, 0, 0], black, black, black].concat());
    assert_eq!(planes.all()[2], [128 + 112 / 4]);
}

#[test]
fn pictures_that_no_player_has_to_show_are_refused() {
    assert_eq!(level([640, 480], 10.0), Some(40));
    assert_eq!(level([640, 480], 1000.0), Some(52));
    assert_eq!(level([8192, 16], 1.0), Some(51));
    assert_eq!(level([8192, 4320], 1000.0), Some(62));
    let refused = Video::begin(Cursor::new(Vec::new()), [8192, 8192], 10.0).err().expect("it is too large").to_string();
    assert!(refused.contains("8192 x 8192 pixels") && refused.contains(".gif"), "{refused}");
}
