//! The colours of cars, with their frequencies in traffic.

use paracosm_engine::object::Colour;

/// A colour of paint with its share among cars.
#[derive(Debug)]
pub(crate) struct Paint {
    /// The share of the colour among cars, in percent.
    pub share: u32,
    /// Shades of the colour, which are equally frequent.
    pub shades: &'static [Colour],
}

/// The colours of new cars in the world in 2020. The shares of white, black, grey and silver, 81 % together, are those of
/// Axalta's 68th Global Automotive Color Popularity Report (December 2020). The division of the other 19 % is our
/// estimate, with blue before red, as the coating makers report.
pub(crate) const PAINTS: [Paint; 10] = [
    // White.
    Paint { share: 38, shades: &[[236, 237, 236], [226, 228, 229], [240, 238, 230]] },
    // Black.
    Paint { share: 19, shades: &[[20, 20, 22], [28, 29, 33], [16, 17, 22]] },
    // Grey.
    Paint { share: 15, shades: &[[92, 95, 99], [70, 73, 78], [118, 120, 122]] },
    // Silver.
    Paint { share: 9, shades: &[[176, 179, 182], [160, 165, 170]] },
    // Blue.
    Paint { share: 7, shades: &[[26, 48, 98], [36, 84, 150], [22, 34, 60]] },
    // Red.
    Paint { share: 5, shades: &[[150, 22, 26], [110, 16, 24], [178, 32, 26]] },
    // Brown or beige.
    Paint { share: 3, shades: &[[92, 74, 58], [166, 150, 126]] },
    // Green.
    Paint { share: 2, shades: &[[36, 66, 48], [78, 96, 72]] },
    // Yellow.
    Paint { share: 1, shades: &[[226, 178, 30]] },
    // Orange.
    Paint { share: 1, shades: &[[206, 92, 26]] },
];

/// Returns the colour of a car, by a number that chance has chosen.
pub(crate) fn paint(chance: u32) -> Colour {
    let mut left = chance % 100;
    for paint in &PAINTS {
        match left.checked_sub(paint.share) {
            Some(rest) => left = rest,
            None => return paint.shades[(chance / 100) as usize % paint.shades.len()],
        }
    }
    PAINTS[0].shades[0]
}
