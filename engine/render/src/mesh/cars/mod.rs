//! Passenger cars of the look `textured`: bodies of many kinds, each described by the lines of its side view.
//!
//! A car is modelled for the size of its body, so that the wheels of a stretched car stay round.

mod details;
mod far;
pub(crate) mod paints;
mod shell;

use super::Mesh;
use super::clay::Clay;

/// The description of a kind of car by its natural measures, in metres. Places are metres ahead of the middle of the
/// car, and metres above the ground.
#[derive(Debug)]
pub(crate) struct Lines {
    /// The share of the kind among all cars in traffic, in percent: our estimate for Europe.
    pub share: u32,
    /// Length, width and height.
    pub size: [f32; 3],
    /// The places of the axles along the car, the rear one first.
    axles: [f32; 2],
    /// The radius of a wheel.
    wheel: f32,
    /// The height of the lower edge of the sides.
    sill: f32,
    /// The upper edge of the body without its cabin, from the rear end to the front end.
    belt: &'static [[f32; 2]],
    /// The line of the rear window, the roof and the windscreen, from the lower edge of the rear window to the lower edge
    /// of the windscreen. The second and the last but one point are the ends of the roof.
    roof: &'static [[f32; 2]],
    /// The half-width of the roof as a share of the half-width of the car.
    narrow: f32,
    /// The rear and the front edge of each side window, along the car.
    windows: &'static [[f32; 2]],
    /// The rear and the front edge of an open loading bed.
    bed: Option<[f32; 2]>,
}

/// The colour of a rear lamp that does not shine, in linear light: darker than a lamp that does.
const LENS: [f32; 3] = [0.26, 0.008, 0.008];

/// All kinds of cars.
pub(crate) const KINDS: [Lines; 10] = [
    // A hatchback.
    Lines {
        share: 26,
        size: [4.25, 1.79, 1.46],
        axles: [-1.37, 1.26],
        wheel: 0.32,
        sill: 0.21,
        belt: &[[-2.125, 0.80], [-2.06, 0.98], [-1.2, 0.97], [0.80, 0.93], [1.78, 0.82], [2.125, 0.70]],
        roof: &[[-2.05, 0.99], [-1.58, 1.37], [-0.9, 1.44], [-0.25, 1.46], [0.10, 1.41], [0.98, 0.93]],
        narrow: 0.70,
        windows: &[[-1.62, -1.28], [-1.20, -0.42], [-0.32, 0.62]],
        bed: None,
    },
    // A small car.
    Lines {
        share: 15,
        size: [3.62, 1.63, 1.49],
        axles: [-1.20, 1.16],
        wheel: 0.29,
        sill: 0.21,
        belt: &[[-1.81, 0.78], [-1.75, 1.00], [-1.0, 0.98], [0.80, 0.93], [1.50, 0.85], [1.81, 0.70]],
        roof: &[[-1.75, 1.02], [-1.42, 1.40], [-0.8, 1.48], [-0.15, 1.49], [0.22, 1.43], [0.98, 0.93]],
        narrow: 0.71,
        windows: &[[-1.45, -0.62], [-0.50, 0.62]],
        bed: None,
    },
    // A saloon.
    Lines {
        share: 13,
        size: [4.70, 1.83, 1.44],
        axles: [-1.36, 1.45],
        wheel: 0.33,
        sill: 0.20,
        belt: &[[-2.35, 0.74], [-2.26, 1.00], [-1.55, 1.01], [0.85, 0.93], [1.98, 0.80], [2.35, 0.68]],
        roof: &[[-1.86, 1.02], [-1.08, 1.37], [-0.6, 1.43], [-0.10, 1.44], [0.24, 1.39], [1.10, 0.93]],
        narrow: 0.68,
        windows: &[[-1.30, -0.46], [-0.36, 0.66]],
        bed: None,
    },
    // An estate.
    Lines {
        share: 9,
        size: [4.70, 1.83, 1.47],
        axles: [-1.36, 1.45],
        wheel: 0.33,
        sill: 0.20,
        belt: &[[-2.35, 0.78], [-2.29, 0.98], [-1.5, 0.98], [0.85, 0.93], [1.98, 0.80], [2.35, 0.68]],
        roof: &[[-2.28, 0.99], [-1.92, 1.38], [-1.2, 1.45], [-0.10, 1.47], [0.24, 1.42], [1.10, 0.93]],
        narrow: 0.70,
        windows: &[[-1.90, -1.30], [-1.20, -0.46], [-0.36, 0.66]],
        bed: None,
    },
    // An SUV.
    Lines {
        share: 22,
        size: [4.55, 1.87, 1.67],
        axles: [-1.36, 1.33],
        wheel: 0.365,
        sill: 0.30,
        belt: &[[-2.275, 0.86], [-2.21, 1.12], [-1.3, 1.10], [0.85, 1.06], [1.92, 0.99], [2.275, 0.86]],
        roof: &[[-2.21, 1.13], [-1.88, 1.55], [-1.1, 1.66], [-0.2, 1.67], [0.16, 1.61], [1.02, 1.06]],
        narrow: 0.71,
        windows: &[[-1.92, -1.36], [-1.26, -0.42], [-0.32, 0.66]],
        bed: None,
    },
    // A coupe.
    Lines {
        share: 2,
        size: [4.63, 1.84, 1.38],
        axles: [-1.33, 1.45],
        wheel: 0.335,
        sill: 0.18,
        belt: &[[-2.315, 0.74], [-2.22, 0.98], [-1.5, 0.98], [0.75, 0.91], [1.95, 0.76], [2.315, 0.63]],
        roof: &[[-2.02, 0.99], [-1.00, 1.32], [-0.6, 1.37], [-0.16, 1.38], [0.16, 1.33], [1.06, 0.91]],
        narrow: 0.66,
        windows: &[[-1.18, -0.62], [-0.50, 0.58]],
        bed: None,
    },
    // A sports car.
    Lines {
        share: 1,
        size: [4.40, 1.86, 1.26],
        axles: [-1.30, 1.30],
        wheel: 0.335,
        sill: 0.15,
        belt: &[[-2.20, 0.70], [-2.10, 0.88], [-1.3, 0.93], [0.70, 0.84], [1.50, 0.77], [2.20, 0.55]],
        roof: &[[-1.95, 0.90], [-0.80, 1.22], [-0.45, 1.255], [-0.10, 1.26], [0.14, 1.22], [1.04, 0.84]],
        narrow: 0.62,
        windows: &[[-0.72, 0.60]],
        bed: None,
    },
    // A pick-up.
    Lines {
        share: 2,
        size: [5.30, 1.87, 1.79],
        axles: [-1.62, 1.60],
        wheel: 0.385,
        sill: 0.40,
        belt: &[[-2.65, 0.80], [-2.60, 1.12], [-0.80, 1.12], [1.0, 1.12], [2.25, 1.06], [2.65, 0.95]],
        roof: &[[-0.86, 1.12], [-0.66, 1.68], [-0.3, 1.77], [0.25, 1.79], [0.52, 1.73], [1.22, 1.12]],
        narrow: 0.74,
        windows: &[[-0.64, -0.02], [0.10, 0.92]],
        bed: Some([-2.50, -0.98]),
    },
    // An MPV.
    Lines {
        share: 8,
        size: [4.55, 1.83, 1.66],
        axles: [-1.40, 1.40],
        wheel: 0.325,
        sill: 0.22,
        belt: &[[-2.275, 0.82], [-2.22, 1.02], [-1.2, 1.00], [1.10, 0.96], [1.90, 0.84], [2.275, 0.70]],
        roof: &[[-2.22, 1.03], [-1.95, 1.54], [-1.2, 1.65], [-0.1, 1.66], [0.34, 1.58], [1.45, 0.96]],
        narrow: 0.72,
        windows: &[[-1.98, -1.32], [-1.22, -0.30], [-0.20, 0.72], [0.80, 1.16]],
        bed: None,
    },
    // An off-roader.
    Lines {
        share: 2,
        size: [4.55, 1.88, 1.86],
        axles: [-1.35, 1.38],
        wheel: 0.40,
        sill: 0.42,
        belt: &[[-2.275, 0.94], [-2.26, 1.18], [-1.2, 1.18], [0.75, 1.18], [2.10, 1.13], [2.275, 1.04]],
        roof: &[[-2.25, 1.20], [-2.14, 1.74], [-1.4, 1.84], [0.0, 1.86], [0.36, 1.80], [0.82, 1.18]],
        narrow: 0.82,
        windows: &[[-2.10, -1.42], [-1.32, -0.52], [-0.42, 0.40]],
        bed: None,
    },
];

/// The greatest ratio by which the proportions of a car may differ from its natural ones.
const STRETCH: f32 = 1.3;

/// Returns the place in [`KINDS`] of the kind of a car of a size, by a number that chance has chosen. Kinds of other
/// proportions are left out: no sports car is as high as a delivery van.
pub(crate) fn kind(size: [f32; 3], chance: u32) -> usize {
    let fits = |lines: &Lines| {
        let ratio = (size[2] / size[0]) / (lines.size[2] / lines.size[0]);
        (1.0 / STRETCH..=STRETCH).contains(&ratio)
    };
    let fitting: Vec<usize> = (0..KINDS.len()).filter(|kind| fits(&KINDS[*kind])).collect();
    let all: u32 = fitting.iter().map(|kind| KINDS[*kind].share).sum();
    let mut left = chance % all.max(1);
    for kind in &fitting {
        match left.checked_sub(KINDS[*kind].share) {
            Some(rest) => left = rest,
            None => return *kind,
        }
    }
    0
}

/// The sizes in metres of the largest parts that are missing from afar, and from very far.
const HANDLE: f32 = 0.09;
const WHEEL_ARCH: f32 = 0.21;

/// Makes a car of a kind with a length, a width and a height in metres.
pub(crate) fn car(kind: usize, size: [f32; 3]) -> Mesh {
    let mesh = |coarse: bool| {
        let shell = shell::Shell::new(&KINDS[kind], size, coarse);
        let mut clay = Clay::default();
        shell.body(&mut clay);
        shell.cabin(&mut clay);
        shell.details(&mut clay);
        clay.fitted(size).mesh()
    };
    let mut far = Clay::default();
    shell::Shell::new(&KINDS[kind], size, true).far(&mut far);
    mesh(false).with_coarse(mesh(true).with_coarse(far.fitted(size).mesh(), WHEEL_ARCH), HANDLE)
}

#[cfg(test)]
mod tests;
