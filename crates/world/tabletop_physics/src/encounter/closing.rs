//! When gaps close.

/// The first time, in s, at which `gap = speed * time + acceleration * time² / 2`; infinite if there is none.
pub(crate) fn time_to_close(gap: f64, speed: f64, acceleration: f64) -> f64 {
    if gap <= 0.0 && speed >= 0.0 {
        return 0.0;
    }
    let square = speed * speed + 2.0 * acceleration * gap;
    let sum = speed + square.max(0.0).sqrt();
    match square >= 0.0 && sum > 0.0 {
        true => 2.0 * gap / sum,
        false if acceleration > 0.0 => -2.0 * speed / acceleration,
        false => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_closes_when_the_way_is_as_long() {
        for (gap, speed, acceleration) in [
            (1.0, 3.0, 0.0),
            (1.0, 0.0, 8.0),
            (0.2, -1.0, 9.0),
            (0.0, -2.0, 10.0),
        ] {
            let time = time_to_close(gap, speed, acceleration);
            let way = speed * time + 0.5 * acceleration * time * time;
            assert!(
                (way - gap).abs() < 1e-9 && time > 0.0,
                "{gap} {speed} {acceleration}"
            );
        }
        assert_eq!(time_to_close(0.0, 1.0, 0.0), 0.0);
        assert_eq!(time_to_close(1.0, -1.0, 0.0), f64::INFINITY);
    }
}
