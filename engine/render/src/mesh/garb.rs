//! The build, the hair and the clothes of people. Jackets have the colour of the body.

use super::colours::{BLACK, HAIR, SKIN, TROUSERS};

/// The cut of a person's clothes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Cut {
    /// A jacket over trousers.
    Jacket,
    /// A jacket that reaches to the knees.
    Coat,
    /// A shirt with short sleeves over trousers.
    Shirt,
    /// A jacket over a skirt.
    Skirt,
}

/// The hair of a person.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Hair {
    Short,
    Long,
    /// A cap in the colour of the jacket.
    Cap,
}

/// The build, the hair and the clothes of a person, with colours in linear light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Garb {
    pub cut: Cut,
    pub hairdo: Hair,
    /// The girth of the waist, relative to the girth of the usual person.
    pub belly: f32,
    pub skin: [f32; 3],
    pub hair: [f32; 3],
    /// The colour of the trousers or of the skirt.
    pub trousers: [f32; 3],
    pub shoes: [f32; 3],
    /// The colour of a bag on the back, if there is one.
    pub bag: Option<[f32; 3]>,
}

/// The garb of all people in the look `flat`.
pub(crate) const USUAL: Garb = Garb {
    cut: Cut::Jacket,
    hairdo: Hair::Short,
    belly: 1.0,
    skin: SKIN,
    hair: HAIR,
    trousers: TROUSERS,
    shoes: BLACK,
    bag: None,
};

const SKINS: [[f32; 3]; 5] =
    [[0.68, 0.43, 0.32], [0.62, 0.36, 0.24], [0.45, 0.24, 0.14], [0.26, 0.125, 0.07], [0.11, 0.05, 0.03]];
const HAIRS: [[f32; 3]; 5] =
    [[0.02, 0.016, 0.014], [0.06, 0.035, 0.02], [0.13, 0.075, 0.04], [0.38, 0.26, 0.12], [0.36, 0.35, 0.34]];
const DENIM: [f32; 3] = [0.035, 0.055, 0.11];
const DARK: [f32; 3] = [0.015, 0.015, 0.018];
const SAND: [f32; 3] = [0.30, 0.23, 0.14];
const ASH: [f32; 3] = [0.10, 0.10, 0.105];
const PALE: [f32; 3] = [0.55, 0.54, 0.51];
const WINE: [f32; 3] = [0.16, 0.02, 0.03];
const OLIVE: [f32; 3] = [0.07, 0.075, 0.035];

const fn garb(cut: Cut, hairdo: Hair, belly: f32, [skin, hair]: [usize; 2], trousers: [f32; 3]) -> Garb {
    Garb { cut, hairdo, belly, skin: SKINS[skin], hair: HAIRS[hair], trousers, shoes: BLACK, bag: None }
}

/// The garbs of people in the look `textured`, which are equally frequent.
pub(crate) const GARBS: [Garb; 16] = [
    garb(Cut::Jacket, Hair::Short, 1.0, [1, 1], DENIM),
    Garb { bag: Some(DARK), ..garb(Cut::Jacket, Hair::Short, 0.92, [0, 2], DARK) },
    garb(Cut::Coat, Hair::Short, 1.1, [1, 4], DARK),
    garb(Cut::Jacket, Hair::Cap, 1.35, [0, 1], DENIM),
    Garb { shoes: PALE, ..garb(Cut::Shirt, Hair::Short, 1.05, [2, 0], SAND) },
    garb(Cut::Skirt, Hair::Long, 0.9, [0, 3], DARK),
    garb(Cut::Jacket, Hair::Long, 0.88, [1, 1], DENIM),
    Garb { bag: Some(WINE), ..garb(Cut::Shirt, Hair::Long, 0.9, [2, 1], DENIM) },
    garb(Cut::Coat, Hair::Long, 0.95, [0, 2], ASH),
    Garb { shoes: PALE, ..garb(Cut::Shirt, Hair::Short, 1.4, [1, 4], ASH) },
    garb(Cut::Jacket, Hair::Short, 1.0, [4, 0], SAND),
    garb(Cut::Skirt, Hair::Long, 1.15, [3, 0], WINE),
    Garb { shoes: PALE, bag: Some(OLIVE), ..garb(Cut::Jacket, Hair::Cap, 0.95, [3, 0], OLIVE) },
    garb(Cut::Jacket, Hair::Short, 1.3, [0, 4], ASH),
    Garb { shoes: SAND, ..garb(Cut::Jacket, Hair::Short, 0.95, [2, 0], PALE) },
    garb(Cut::Skirt, Hair::Short, 1.2, [1, 4], OLIVE),
];

impl Garb {
    /// Returns the colour of the legs below the knees.
    pub fn shins(&self) -> [f32; 3] {
        if self.cut == Cut::Skirt { self.skin } else { self.trousers }
    }
}
