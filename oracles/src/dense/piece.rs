//! Straight lines between two instants, and the points at which they cross.

/// The least time between a crossing and the instants around it, in units. A nearer crossing is moved, and keeps its value. Later sums round
/// times by much less, so that an instant at which a function jumps never gets a crossing as a fourth breakpoint.
const APART: f64 = 1e-8;

/// Returns the value at an instant of the line through two points.
pub(super) fn between((t0, v0): (f64, f64), (t1, v1): (f64, f64), time: f64) -> f64 {
    if time <= t0 || v0 == v1 {
        v0
    } else if time >= t1 {
        v1
    } else {
        v0 + (v1 - v0) * ((time - t0) / (t1 - t0))
    }
}

/// Lines from one instant to another. The second instant may be earlier, or the same: then the lines are jumps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece<const N: usize> {
    pub from: f64,
    pub to: f64,
    pub lines: [(f64, f64); N],
}

impl<const N: usize> Piece<N> {
    /// Appends the breakpoints of the function that `join` makes from the lines, except the first breakpoint. Wherever
    /// two lines cross there is a breakpoint.
    #[inline]
    pub fn push(self, points: &mut Vec<(f64, f64)>, join: impl Fn([f64; N]) -> f64) {
        let Self { from, to, lines } = self;
        let mut crossings = [f64::INFINITY; 3];
        let mut count = 0;
        // A jump has no instants between its values.
        let lasting = if from == to { &lines[..0] } else { &lines[..] };
        for (i, a) in lasting.iter().enumerate() {
            for b in &lines[..i] {
                let (before, after) = (a.0 - b.0, a.1 - b.1);
                if before * after < 0.0 && (before - after).is_finite() {
                    crossings[count] = before / (before - after);
                    count += 1;
                }
            }
        }
        if count > 1 {
            crossings[..count].sort_by(f64::total_cmp);
        }
        let mut last = from;
        let apart = APART.copysign(to - from);
        let has_room = (to - from).abs() > APART * (count + 1) as f64;
        for (place, share) in crossings[..count].iter().enumerate() {
            let mut time = from + (to - from) * share;
            if has_room {
                let ends = [last + apart, to - apart * (count - place) as f64];
                time = time.clamp(ends[0].min(ends[1]), ends[0].max(ends[1]));
            } else if time == last || time == to {
                // After rounding, the crossing has no instant of its own.
                continue;
            }
            let values = lines.map(|(v0, v1)| if v0 == v1 { v0 } else { v0 + (v1 - v0) * share });
            push(points, (time, join(values)));
            last = time;
        }
        push(points, (to, join(lines.map(|line| line.1))));
    }
}

/// Appends a breakpoint. Drops a breakpoint between two equal values. Of three equal values at one instant, keeps one.
pub(super) fn push(points: &mut Vec<(f64, f64)>, point: (f64, f64)) {
    if let [.., before, last] = points[..]
        && before.1 == point.1
        && last.1 == point.1
    {
        if last.0 != point.0 && before.0 != last.0 {
            points.pop();
        } else if last.0 == point.0 && before.0 == last.0 {
            points.pop();
            return;
        }
    }
    points.push(point);
}
