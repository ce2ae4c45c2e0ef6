//! Piecewise linear functions found from their values alone, so that they share no algorithm with the crate.

/// Times closer than that are one. No function here is so steep that more than [`EXACT`] is lost by it.
const SAME: f64 = 1e-9;
/// How far from a line values may be that lie on it.
const EXACT: f64 = 1e-8;

/// The multiple of an eighth that is so near: functions jump at these, from which no rounding is to lead astray.
fn exact(time: f64) -> f64 {
    let eighth = (time * 8.0).round() / 8.0;
    if (time - eighth).abs() <= SAME { eighth } else { time }
}

/// A piecewise linear function from 0 to its end, at its instants and between them.
#[derive(Debug, Clone)]
pub struct Curve {
    /// The ends of its pieces, from 0 on.
    pub times: Vec<f64>,
    /// The values at these.
    values: Vec<f64>,
    /// The limits at both ends of each piece.
    pieces: Vec<(f64, f64)>,
}

impl Curve {
    /// The function with these values, which is continuous and piecewise linear between these instants.
    /// At these it is what `value` says, which need not be near what it is beside them.
    pub fn new(end: f64, instants: impl IntoIterator<Item = f64>, value: impl Fn(f64) -> f64) -> Self {
        let mut instants: Vec<f64> = instants.into_iter().map(exact).collect();
        instants.retain(|time| *time > SAME && *time < end - SAME);
        instants.extend([0.0, end]);
        instants.sort_by(f64::total_cmp);
        instants.dedup_by(|later, earlier| *later - *earlier <= SAME);
        let mut curve = Self { times: vec![0.0], values: vec![value(0.0)], pieces: Vec::new() };
        for ends in instants.windows(2) {
            curve.discover(&value, [ends[0], ends[1]], 0);
        }
        curve
    }

    /// Appends what the values between two instants come to: one piece, or what is found on both sides of where the
    /// lines at the two ends meet.
    fn discover(&mut self, value: &impl Fn(f64) -> f64, [from, to]: [f64; 2], depth: usize) {
        let at = |share: f64| from + (to - from) * share;
        let line = |a: f64, b: f64| {
            let (first, second) = (value(at(a)), value(at(b)));
            let slope = if first == second { 0.0 } else { (second - first) / (b - a) };
            (first - slope * a, slope)
        };
        let (early, late) = (line(0.125, 0.25), line(0.75, 0.875));
        let on = |line: (f64, f64), share: f64| line.0 + line.1 * share;
        let near = |a: f64, b: f64| a == b || (a - b).abs() <= EXACT;
        let is_line = near(on(early, 0.0), on(late, 0.0))
            && near(on(early, 1.0), on(late, 1.0))
            && [1e-7, 1e-3, 0.3717, 0.6127, 0.999, 1.0 - 1e-7]
                .iter()
                .all(|share| near(value(at(*share)), on(early, *share)));
        if is_line || to - from <= 4.0 * SAME {
            return self.push(to, value(to), (on(early, 0.0), on(late, 1.0)));
        }
        assert!(depth < 60, "not piecewise linear from {from} to {to}");
        let meeting = (late.0 - early.0) / (early.1 - late.1);
        let share = if meeting > 0.01 && meeting < 0.99 { meeting } else { 0.381 };
        let middle = Some(exact(at(share))).filter(|middle| from < *middle && *middle < to).unwrap_or(at(share));
        self.discover(value, [from, middle], depth + 1);
        self.discover(value, [middle, to], depth + 1);
    }

    /// Appends a piece, or makes the last one longer if both are one.
    fn push(&mut self, to: f64, value: f64, piece: (f64, f64)) {
        if let ([.., before, from], [.., here], Some(last)) =
            (&self.times[..], &mut self.values[..], self.pieces.last_mut())
        {
            let slope = |piece: (f64, f64), length: f64| (piece.1 - piece.0) / length;
            let near = |a: f64, b: f64| a == b || (a - b).abs() <= 1e-12;
            let joins = near(last.1, piece.0) && near(last.1, *here);
            let straight = (slope(*last, from - before) - slope(piece, to - from)).abs() <= 1e-10;
            if joins && (straight || *last == piece) {
                last.1 = piece.1;
                *here = value;
                *self.times.last_mut().unwrap() = to;
                return;
            }
        }
        self.times.push(to);
        self.values.push(value);
        self.pieces.push(piece);
    }

    pub fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// The value at an instant.
    pub fn at(&self, time: f64) -> f64 {
        let place = self.times.partition_point(|end| *end < time);
        if self.times[place] == time { self.values[place] } else { self.on(place - 1, time) }
    }

    /// The limit from below; at 0 the value.
    pub fn left(&self, time: f64) -> f64 {
        match self.times.partition_point(|end| *end < time) {
            0 => self.values[0],
            piece => self.on(piece - 1, time),
        }
    }

    /// The limit from above at an instant before the end.
    pub fn right(&self, time: f64) -> f64 {
        self.on(self.times.partition_point(|end| *end <= time) - 1, time)
    }

    fn on(&self, piece: usize, time: f64) -> f64 {
        let (from, to) = (self.times[piece], self.times[piece + 1]);
        let (first, last) = self.pieces[piece];
        if first == last { first } else { first + (last - first) * ((time - from) / (to - from)) }
    }

    /// The instants between two others at which any of these functions bends or jumps, and these two.
    pub fn instants(curves: &[&Self], [from, to]: [f64; 2]) -> Vec<f64> {
        let inner = curves.iter().flat_map(|curve| curve.times.iter().copied());
        let mut instants: Vec<f64> = inner.filter(|time| from < *time && *time < to).collect();
        instants.extend([from, to]);
        instants.sort_by(f64::total_cmp);
        instants.dedup();
        instants
    }
}
