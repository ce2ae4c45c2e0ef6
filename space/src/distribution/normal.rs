//! The normal distribution, and the normal distribution restricted to an interval.

#![expect(clippy::excessive_precision, reason = "coefficients stand as they were published")]

use std::f64::consts::SQRT_2;

/// Returns the probability that a number from the standard normal distribution is at most `z`.
pub fn normal_cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z / SQRT_2)
}

/// Returns the number below which a share `p` of the standard normal distribution lies. It is infinite for 0 and 1.
///
/// The relative error is about 1e-16. The algorithm is PPND16 of Wichura (Algorithm AS 241: The percentage points of
/// the normal distribution, Applied Statistics 37, 1988).
pub fn normal_quantile(p: f64) -> f64 {
    if p <= 0.0 {
        return f64::NEG_INFINITY;
    }
    if p >= 1.0 {
        return f64::INFINITY;
    }
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.180_625 - q * q;
        return q * ratio(&CENTRE, r);
    }
    let r = (-libm::log(if q < 0.0 { p } else { 1.0 - p })).sqrt();
    let z = if r <= 5.0 { ratio(&MIDDLE, r - 1.6) } else { ratio(&TAIL, r - 5.0) };
    if q < 0.0 { -z } else { z }
}

/// The coefficients of a numerator and a denominator, beginning with the constant term.
type Ratio = [[f64; 8]; 2];

const CENTRE: Ratio = [
    [
        3.387_132_872_796_366_608_0,
        1.331_416_678_917_843_774_5e2,
        1.971_590_950_306_551_442_7e3,
        1.373_169_376_550_946_112_5e4,
        4.592_195_393_154_987_145_7e4,
        6.726_577_092_700_870_085_3e4,
        3.343_057_558_358_812_810_5e4,
        2.509_080_928_730_122_672_7e3,
    ],
    [
        1.0,
        4.231_333_070_160_091_125_2e1,
        6.871_870_074_920_579_083_0e2,
        5.394_196_021_424_751_107_7e3,
        2.121_379_430_158_659_586_7e4,
        3.930_789_580_009_271_061_0e4,
        2.872_908_573_572_194_267_4e4,
        5.226_495_278_852_854_561_0e3,
    ],
];

const MIDDLE: Ratio = [
    [
        1.423_437_110_749_683_577_34,
        4.630_337_846_156_545_295_90,
        5.769_497_221_460_691_405_50,
        3.647_848_324_763_204_605_04,
        1.270_458_252_452_368_382_58,
        2.417_807_251_774_506_117_70e-1,
        2.272_384_498_926_918_458_33e-2,
        7.745_450_142_783_414_076_40e-4,
    ],
    [
        1.0,
        2.053_191_626_637_758_821_87,
        1.676_384_830_183_803_849_40,
        6.897_673_349_851_000_045_50e-1,
        1.481_039_764_274_800_745_90e-1,
        1.519_866_656_361_645_719_66e-2,
        5.475_938_084_995_344_946_00e-4,
        1.050_750_071_644_416_843_24e-9,
    ],
];

const TAIL: Ratio = [
    [
        6.657_904_643_501_103_777_20,
        5.463_784_911_164_114_369_90,
        1.784_826_539_917_291_335_80,
        2.965_605_718_285_048_912_30e-1,
        2.653_218_952_657_612_309_30e-2,
        1.242_660_947_388_078_438_60e-3,
        2.711_555_568_743_487_578_15e-5,
        2.010_334_399_292_288_132_65e-7,
    ],
    [
        1.0,
        5.998_322_065_558_879_376_90e-1,
        1.369_298_809_227_358_053_10e-1,
        1.487_536_129_085_061_485_25e-2,
        7.868_691_311_456_132_591_00e-4,
        1.846_318_317_510_054_681_80e-5,
        1.421_511_758_316_445_888_70e-7,
        2.044_263_103_389_939_785_64e-15,
    ],
];

fn ratio([numerator, denominator]: &Ratio, r: f64) -> f64 {
    let horner = |coefficients: &[f64; 8]| coefficients.iter().rev().fold(0.0, |sum, c| sum * r + c);
    horner(numerator) / horner(denominator)
}

/// A normal distribution under the condition that the number lies in an interval.
pub(super) struct Truncated {
    /// The ends of the interval, in standard deviations from the mean.
    ends: [f64; 2],
    /// `true` if the interval is mirrored at the mean, so that at most half of it lies above the mean.
    mirrored: bool,
}

impl Truncated {
    pub fn new(mean: f64, sd: f64, lo: f64, hi: f64) -> Self {
        let [from, to] = [lo, hi].map(|end| (end - mean) / sd);
        let mirrored = from + to > 0.0;
        Self { ends: if mirrored { [-to, -from] } else { [from, to] }, mirrored }
    }

    /// Returns the share of the unrestricted normal distribution that lies in the interval.
    pub fn mass(&self) -> f64 {
        normal_cdf(self.ends[1]) - normal_cdf(self.ends[0])
    }

    /// Returns the number below which a share `u` of the distribution lies, in standard deviations from the mean.
    pub fn deviations(&self, u: f64) -> f64 {
        let z = self.on_the_side(u);
        if self.mirrored { -z } else { z }
    }

    /// Returns the coordinate in `[0,1]` of the interval below which a share `u` of the distribution lies.
    pub fn quantile(&self, u: f64) -> f64 {
        let [from, to] = self.ends;
        let coordinate = ((self.on_the_side(u) - from) / (to - from)).clamp(0.0, 1.0);
        if self.mirrored { 1.0 - coordinate } else { coordinate }
    }

    /// Returns the number of [`Truncated::deviations`], mirrored if the interval is.
    fn on_the_side(&self, u: f64) -> f64 {
        let [from, to] = self.ends;
        let (u, rest) = if self.mirrored { (1.0 - u, u) } else { (u, 1.0 - u) };
        let (below, above) = (normal_cdf(from) + u * self.mass(), normal_cdf(-to) + rest * self.mass());
        // Start from the side with the smaller share: a small share has all its digits.
        if below < above { normal_quantile(below) } else { -normal_quantile(above) }
    }
}
