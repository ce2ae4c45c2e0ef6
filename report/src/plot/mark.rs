//! The marks of a failure map: the verdict of a test, or whose fault its failure is. The marks are told apart by
//! colours that differ for any colour vision (Paul Tol's vibrant scheme), and without colour by their shapes.

use super::INK;
use paracosm_analysis::blame::Preventability;
use paracosm_oracles::Verdict;
use plotters::element::{Drawable, PointCollection};
use plotters::prelude::*;
use plotters_backend::DrawingErrorKind;
use std::fmt;

pub(super) const BLUE: RGBColor = RGBColor(0x00, 0x77, 0xbb);
pub(super) const RED: RGBColor = RGBColor(0xcc, 0x33, 0x11);
const ORANGE: RGBColor = RGBColor(0xee, 0x77, 0x33);
const MAGENTA: RGBColor = RGBColor(0xee, 0x33, 0x77);
pub(super) const GREY: RGBColor = RGBColor(0x88, 0x88, 0x88);

/// The property of a test that determines its mark on a failure map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// The verdict of the test.
    Verdict(Verdict),
    /// The blame for the failure of the test, according to the reference drivers.
    Fault(Preventability),
}

/// The marks in the order in which they are drawn. The most important marks are drawn last, over all others. The legend
/// lists them in reverse order.
pub(super) const ORDER: [Mark; 10] = [
    Mark::Verdict(Verdict::Pass),
    Mark::Verdict(Verdict::Inconclusive),
    Mark::Verdict(Verdict::Invalid),
    Mark::Verdict(Verdict::Error),
    Mark::Verdict(Verdict::Unpreventable),
    Mark::Verdict(Verdict::Fail),
    Mark::Fault(Preventability::Unknown),
    Mark::Fault(Preventability::Unpreventable),
    Mark::Fault(Preventability::Preventable),
    Mark::Fault(Preventability::Induced),
];

impl Mark {
    /// Returns `true` if the legend lists the mark even if no test has it; `of_faults` is true for a map of faults.
    pub(super) fn is_listed(self, of_faults: bool) -> bool {
        match self {
            Self::Verdict(Verdict::Pass) => true,
            Self::Verdict(Verdict::Fail) => !of_faults,
            Self::Verdict(_) | Self::Fault(Preventability::Unknown) => false,
            Self::Fault(_) => of_faults,
        }
    }
}

impl fmt::Display for Mark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Verdict(verdict) => verdict.fmt(f),
            Self::Fault(fault) => fault.fmt(f),
        }
    }
}

/// A mark to be drawn, `side` pixels from its middle to its end.
pub(super) struct Drawn {
    pub mark: Mark,
    pub side: f64,
}

impl<'a> PointCollection<'a, (i32, i32)> for &'a Drawn {
    type Point = (i32, i32);
    type IntoIter = std::iter::Once<(i32, i32)>;

    fn point_iter(self) -> Self::IntoIter {
        std::iter::once((0, 0))
    }
}

impl<B: DrawingBackend> Drawable<B> for Drawn {
    fn draw<I: Iterator<Item = (i32, i32)>>(
        &self,
        mut points: I,
        backend: &mut B,
        _: (u32, u32),
    ) -> Result<(), DrawingErrorKind<B::ErrorType>> {
        let Some((x, y)) = points.next() else { return Ok(()) };
        let (side, stroke) = (self.side.round() as i32, (0.55 * self.side).round().max(1.0) as u32);
        match self.mark {
            Mark::Verdict(Verdict::Fail) | Mark::Fault(Preventability::Preventable) => {
                let red = RED.stroke_width(stroke);
                backend.draw_line((x - side, y - side), (x + side, y + side), &red)?;
                backend.draw_line((x - side, y + side), (x + side, y - side), &red)
            }
            Mark::Verdict(Verdict::Pass) => backend.draw_circle((x, y), (0.75 * self.side).round() as u32, &BLUE, true),
            Mark::Verdict(Verdict::Inconclusive) => {
                backend.draw_circle((x, y), side as u32, &GREY.stroke_width(stroke), false)
            }
            Mark::Verdict(Verdict::Invalid) => {
                backend.draw_rect((x - side, y - side), (x + side, y + side), &GREY, false)
            }
            Mark::Verdict(Verdict::Error) => {
                let corners = [(x - side, y + side), (x + side, y + side), (x, y - side)];
                backend.fill_polygon(corners, &ORANGE)
            }
            Mark::Fault(Preventability::Unknown) => {
                let grey = GREY.stroke_width(stroke);
                backend.draw_line((x - side, y - side), (x + side, y + side), &grey)?;
                backend.draw_line((x - side, y + side), (x + side, y - side), &grey)
            }
            Mark::Verdict(Verdict::Unpreventable) | Mark::Fault(Preventability::Unpreventable) => {
                backend.draw_rect((x - side, y - side), (x + side, y + side), &INK, true)
            }
            Mark::Fault(Preventability::Induced) => {
                let side = (1.5 * self.side).round() as i32;
                backend.fill_polygon([(x, y - side), (x + side, y), (x, y + side), (x - side, y)], &MAGENTA)
            }
        }
    }
}
