//! Times of the calendar, as texts of the type `dateTime` of XML Schema give them.

/// Reads a time in the format of XML Schema: `2026-01-31T12:00:00.5+01:00`. The zone may be absent. Returns the seconds since the
/// beginning of the year 1970 in Greenwich, and the seconds by which the zone is ahead.
pub(super) fn moment(text: &str) -> Option<(f64, f64)> {
    let (date, time) = text.split_once('T')?;
    let part = |text: &str, least: i64, most: i64| {
        text.parse::<i64>().ok().filter(|number| (least..=most).contains(number) && !text.starts_with('+'))
    };
    let [year, month, day] = <[&str; 3]>::try_from(date.split('-').collect::<Vec<_>>()).ok()?;
    let (year, month, day) = (part(year, 1, 9999)?, part(month, 1, 12)?, part(day, 1, 31)?);
    let (time, zone) = match time.find(['Z', '+', '-']) {
        None => (time, 0),
        Some(at) if &time[at..] == "Z" => (&time[..at], 0),
        Some(at) => {
            let (hours, minutes) = time[at + 1..].split_once(':')?;
            let minutes = 60 * part(hours, 0, 14)? + part(minutes, 0, 59)?;
            (&time[..at], if time[at..].starts_with('-') { -minutes } else { minutes })
        }
    };
    let [hours, minutes, rest] = <[&str; 3]>::try_from(time.split(':').collect::<Vec<_>>()).ok()?;
    let rest = rest.parse::<f64>().ok().filter(|seconds| (0.0..=60.0).contains(seconds))?;
    let minutes = 60 * part(hours, 0, 24)? + part(minutes, 0, 59)? - zone;
    Some((days(year, month, day) as f64 * 86_400.0 + minutes as f64 * 60.0 + rest, zone as f64 * 60.0))
}

/// Returns the days since the beginning of the year 1970 in the Gregorian calendar. Years begin in March, so that the leap day is the
/// last day.
fn days(year: i64, month: i64, day: i64) -> i64 {
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day - 1 - 719_468
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_counts_from_the_year_1970() {
        for (text, seconds) in [
            ("1970-01-01T00:00:00", 0.0),
            ("2000-03-01T00:00:00Z", 951_868_800.0),
            ("2026-11-26T07:30:00.5+01:00", 1_795_674_600.5),
            ("2024-02-29T23:59:59-05:30", 1_709_270_999.0),
        ] {
            assert_eq!(moment(text).map(|(seconds, _)| seconds), Some(seconds), "{text}");
        }
        for text in ["2026-11-26", "2026-13-01T00:00:00", "T", "2026-01-01T12:00", "2026-01-01T12:00:00+1"] {
            assert_eq!(moment(text), None, "{text}");
        }
    }
}
