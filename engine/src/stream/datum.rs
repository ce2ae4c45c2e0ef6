//! The values of streams, and their layout in the memory of a run.

use nalgebra::Vector2;

/// A stream's value at one tick, or a part of such a value. Only public for [`Datum`]; other crates cannot name it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DatumSample {
    Absent,
    Event,
    Truth(bool),
    Number(f64),
    /// The coordinates of a vector.
    Vector(f64, f64),
    Word(&'static str),
}

impl DatumSample {
    pub fn is_absent(self) -> bool {
        matches!(self, DatumSample::Absent)
    }
}

/// A type of values that streams carry. The types are numbers (`f64`, `i32`), truths (`bool`), words (`&'static str`),
/// vectors in the ground plane (`Vector2<f64>`), the bare event `()`, and pairs of these.
pub trait Datum: Copy + 'static {
    /// The number of samples that a value takes. The value is absent if its first sample is absent.
    #[doc(hidden)]
    const WIDTH: usize;
    /// Writes the value to the first samples of a list.
    #[doc(hidden)]
    fn put(self, samples: &mut [DatumSample]);
    /// Reads the value from the first samples of a list; `None` if the value is absent.
    #[doc(hidden)]
    fn get(samples: &[DatumSample]) -> Option<Self>;
}

macro_rules! datum {
    ($type:ty, $value:ident => $sample:expr, $pattern:pat => $read:expr) => {
        impl Datum for $type {
            const WIDTH: usize = 1;

            #[inline(always)]
            fn put(self, samples: &mut [DatumSample]) {
                // The place comes first: the value is then written to it without a copy on the stack.
                let sample = &mut samples[0];
                let $value = self;
                *sample = $sample;
            }

            fn get(samples: &[DatumSample]) -> Option<Self> {
                match samples[0] {
                    $pattern => Some($read),
                    _ => None,
                }
            }
        }

        impl From<$type> for DatumSample {
            fn from($value: $type) -> Self {
                $sample
            }
        }
    };
}

datum!(bool, truth => DatumSample::Truth(truth), DatumSample::Truth(truth) => truth);
datum!(f64, number => DatumSample::Number(number), DatumSample::Number(number) => number);
datum!(Vector2<f64>, vector => DatumSample::Vector(vector.x, vector.y), DatumSample::Vector(x, y) => Self::new(x, y));
datum!(&'static str, word => DatumSample::Word(word), DatumSample::Word(word) => word);

impl Datum for i32 {
    const WIDTH: usize = 1;

    fn put(self, samples: &mut [DatumSample]) {
        samples[0] = DatumSample::Number(self.into());
    }

    fn get(samples: &[DatumSample]) -> Option<Self> {
        f64::get(samples).map(|number| number as i32)
    }
}

impl Datum for () {
    const WIDTH: usize = 1;

    fn put(self, samples: &mut [DatumSample]) {
        samples[0] = DatumSample::Event;
    }

    fn get(samples: &[DatumSample]) -> Option<Self> {
        (!samples[0].is_absent()).then_some(())
    }
}

impl<A: Datum, B: Datum> Datum for (A, B) {
    const WIDTH: usize = A::WIDTH + B::WIDTH;

    fn put(self, samples: &mut [DatumSample]) {
        self.0.put(samples);
        self.1.put(&mut samples[A::WIDTH..]);
    }

    fn get(samples: &[DatumSample]) -> Option<Self> {
        A::get(samples).zip(B::get(&samples[A::WIDTH..]))
    }
}

/// Returns the samples of a value.
pub(crate) fn samples<T: Datum>(value: T) -> Vec<DatumSample> {
    let mut samples = vec![DatumSample::Absent; T::WIDTH];
    value.put(&mut samples);
    samples
}
